"""Samples per second, and efficiency (time to equal error), of every renderer on the same scene."""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from benchmarks import measures, peers, scenes, settings
from benchmarks.settings import Contender

Row = dict[str, Any]

SPEED_COLUMNS = {
    "renderer": "renderer",
    "samples_per_s": "samples/s|.3g",
    "marginal_per_s": "marginal|.3g",
    "per_cpu_second": "per CPU s|.3g",
    "spp": "spp|g",
    "seconds": "render s|.2f",
    "load_s": "load s|.2f",
    "warm_up_s": "warm-up s|.2f",
    "one_spp_s": "1 spp s|.2f",
    "peak_mb": "peak MB|.0f",
    "mean_rgb": "mean RGB|.4f",
    "error": "error",
}

EFFICIENCY_COLUMNS = {
    "renderer": "renderer",
    "efficiency": "efficiency|.3g",
    "per_cpu_second": "per CPU s|.3g",
    "relative_mse": "relMSE|.3g",
    "seconds": "render s|.2f",
    "spp": "spp|g",
    "reference_spp": "reference spp|g",
    "error_times_spp": "relMSE x spp|.3g",
    "error": "error",
}


@dataclass(frozen=True)
class Options:
    """What the command line may change; the defaults are those of ``settings``."""

    work: Path
    wanted: tuple[str, ...] = peers.PEERS
    repeats: int = settings.REPEATS
    size: int | None = None
    spp: int | None = None
    reference_factor: float = settings.REFERENCE_FACTOR


def measure_speed(scene: str, options: Options) -> list[Row]:
    """One row per renderer for ``scene``; see ``measures.samples_per_second`` for the three rates."""
    size = options.size or settings.SIZE
    folder = scenes.write(scenes.build(scene), options.work / f"{scene}-{size}", size)
    rows = []
    for contender in _chosen(settings.SPEED_CONTENDERS, options):
        task = _timed_pass(options.spp or settings.SPP[contender.peer], options.repeats)
        task |= {"images": str(folder / _file_name(contender))}
        rows.append(_speed_row(contender, peers.run_job(contender, _job(folder, [task]), folder)))
    return rows


def _speed_row(contender: Contender, answer: Row) -> Row:
    if "error" in answer:
        return {"renderer": contender.name, "error": answer["error"]}
    rates, run = measures.samples_per_second(answer), answer["passes"][0]
    return {
        "renderer": contender.name,
        "samples_per_s": rates["whole"],
        "marginal_per_s": rates.get("marginal"),
        "per_cpu_second": rates["per_cpu_second"],
        "spp": run["spp"],
        "seconds": median(run["render_s"]),
        "peak_mb": answer["peak_rss_bytes"] / 1e6,
        "mean_rgb": run["mean_rgb"],
        **{key: answer[key] for key in ("load_s", "warm_up_s", "one_spp_s")},
        "answer": answer,
    }


def measure_efficiency(scene: str, contenders: Sequence[Contender], options: Options, size: int) -> list[Row]:
    """One row per contender for ``scene``: relMSE against the contender's own reference, and 1/(relMSE s).

    ``size`` and the settings' samples per pixel give way to those of ``options``.
    """
    size, spp = options.size or size, options.spp or settings.EFFICIENCY_SPP
    folder = scenes.write(scenes.build(scene), options.work / f"{scene}-{size}", size)
    rows = []
    for contender in _chosen(contenders, options):
        prefix = str(folder / f"{_file_name(contender)}-{spp}")
        task = _timed_pass(spp, options.repeats) | {"images": prefix, "keep": options.repeats}
        answer = peers.run_job(contender, _job(folder, [task]), folder)
        if "error" in answer:
            rows.append({"renderer": contender.name, "error": answer["error"]})
            continue
        taken = answer["passes"][0]["spp"]
        reference = _reference(contender, folder, int(np.ceil(taken * options.reference_factor)))
        images = [np.load(f"{prefix}-{repeat}.npy") for repeat in range(options.repeats)]
        rows.append(_efficiency_row(contender, answer, images, reference))
    return rows


def _efficiency_row(contender: Contender, answer: Row, images: Sequence[measures.Image], reference: Row) -> Row:
    if "error" in reference:
        return {"renderer": contender.name, "error": reference["error"]}
    run = answer["passes"][0]
    error, seconds = measures.relative_mse(images, np.load(reference["file"])), median(run["render_s"])
    return {
        "renderer": contender.name,
        "efficiency": measures.efficiency(error, seconds),
        "per_cpu_second": measures.efficiency(error, median(run["cpu_s"])),
        "relative_mse": error,
        "error_times_spp": error * run["spp"],
        "seconds": seconds,
        "spp": run["spp"],
        "reference_spp": reference["spp"],
        "answer": answer,
    }


def _reference(contender: Contender, folder: Path, spp: int) -> Row:
    """A converged image of the contender's renderer and variant: one that is on disk with enough samples, or a new one.

    A peer is pinned to a version, so its references last; AccuRay changes, so its reference is of this run only.
    """
    plain = Contender(contender.peer, contender.variant, "independent" if contender.sampler else "")
    described = (folder / "scene.json").read_bytes() + repr(settings.REQUIREMENTS.get(plain.peer)).encode()
    prefix = folder / f"reference-{_file_name(plain)}-{spp}-{hashlib.sha256(described).hexdigest()[:12]}"
    file = prefix.with_name(prefix.name + ".npy")
    if file.exists() and contender.peer != "accuray":
        return {"file": str(file), "spp": spp}
    task = {"kind": "reference", "spp": spp, "seed": settings.REFERENCE_SEED, "chunk": settings.REFERENCE_CHUNK}
    job = _job(folder, [task | {"images": str(prefix)}]) | {"warm_up": False}
    answer = peers.run_job(plain, job, folder)
    return answer if "error" in answer else {"file": str(file), "spp": answer["passes"][0]["spp"]}


def _chosen(contenders: Sequence[Contender], options: Options) -> list[Contender]:
    return [contender for contender in contenders if contender.peer in options.wanted]


def _timed_pass(spp: int, repeats: int) -> Row:
    return {"kind": "time", "spp": spp, "seed": settings.MEASURED_SEED, "repeats": repeats}


def _job(folder: Path, passes: list[Row]) -> Row:
    return {"scene": str(folder), "threads": settings.THREADS, "passes": passes}


def _file_name(contender: Contender) -> str:
    return contender.name.replace(":", "-")
