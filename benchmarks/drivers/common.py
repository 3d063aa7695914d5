"""What every driver does: read a job, time the renders, answer with one JSON line.

A driver runs in its renderer's own virtual environment, so this file needs numpy only. A job is a JSON file::

    {"scene": FOLDER, "variant": str, "sampler": str, "threads": int, "warm_up": bool,
     "passes": [{"kind": "time" | "reference" | "memory" | "write", "spp": int, "seed": int, "repeats": int,
                 "chunk": int, "images": PREFIX or null, "keep": int}]}

``time`` renders ``repeats`` times with seeds seed, seed + 1, ... and keeps the first ``keep`` images as
``PREFIX-K.npy``; ``reference`` averages chunks of ``chunk`` spp in float64 into ``PREFIX.npy``; ``memory`` watches the
process during one render; ``write`` renders once and saves ``PREFIX.exr``. Images are linear Rec.709 float32,
(height, width, 3), top row first. The answer's times are wall-clock seconds unless named ``cpu``.
"""

import json
import os
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.float32]
WATCH_EVERY_S = 0.005


class Renderer(Protocol):
    """A renderer with its scene loaded."""

    version: str

    def render(self, spp: int, seed: int) -> float:
        """Render to the end, blocking; return the samples per pixel really taken."""

    def image(self) -> Image:
        """The last render."""

    def write(self, path: str) -> None:
        """Save the last render as OpenEXR."""


Load = Callable[[dict[str, Any], dict[str, Any]], Renderer]
"""Makes a renderer from a job and the content of its ``scene.json``; importing the renderer belongs to it."""


def drive(load: Load) -> None:
    """Run the job named on the command line and print the answer."""
    answer_to = _keep_stdout()
    job = json.loads(Path(sys.argv[1]).read_text())
    scene = json.loads((Path(job["scene"]) / "scene.json").read_text())
    started = time.perf_counter()
    renderer = load(job, scene)
    answer: dict[str, Any] = {"version": renderer.version, "load_s": time.perf_counter() - started}
    if job.get("warm_up", True):
        answer |= _warm_up(renderer, job["passes"][0]["spp"])
    kinds = {"time": _repeat, "reference": _reference, "memory": _watch_memory, "write": _write}
    answer["passes"] = [kinds[task["kind"]](renderer, task) for task in job["passes"]]
    answer |= {"rss_bytes": _memory("VmRSS"), "peak_rss_bytes": _memory("VmHWM")}
    answer_to.write(json.dumps(answer) + "\n")
    answer_to.flush()
    os._exit(0)  # some renderers crash or wait while the interpreter takes them down


def _keep_stdout() -> Any:
    """A stream to the real stdout, while file descriptor 1 goes to stderr: renderers print what they like."""
    kept = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    return kept


def _warm_up(renderer: Renderer, spp: int) -> dict[str, float]:
    """One untimed render as large as the first timed one, then the cost of a call: the faster of two at 1 spp."""
    started = time.perf_counter()
    renderer.render(spp, 0)
    warm_up = time.perf_counter() - started
    calls = [_timed(renderer, 1, seed)["seconds"] for seed in (0, 1, 2)]
    return {"warm_up_s": warm_up, "one_spp_s": min(calls[1:])}


def _timed(renderer: Renderer, spp: int, seed: int) -> dict[str, float]:
    wall, cpu = time.perf_counter(), time.process_time()
    taken = renderer.render(spp, seed)
    return {"seconds": time.perf_counter() - wall, "cpu_s": time.process_time() - cpu, "spp": taken}


def _repeat(renderer: Renderer, task: dict[str, Any]) -> dict[str, Any]:
    """Timed renders with consecutive seeds; a renderer that answers two seeds with the same image is an error."""
    runs, means = [], []
    for repeat in range(task["repeats"]):
        runs.append(_timed(renderer, task["spp"], task["seed"] + repeat))
        pixels = renderer.image()
        means.append(pixels.mean(axis=(0, 1), dtype=np.float64).tolist())
        if task.get("images") and repeat < task.get("keep", 1):
            np.save(f"{task['images']}-{repeat}.npy", pixels)
    if len(means) > 1 and means[0] == means[-1]:
        raise RuntimeError(f"{renderer.version} ignores the seed")
    return {
        "spp": runs[0]["spp"],
        "render_s": [run["seconds"] for run in runs],
        "cpu_s": [run["cpu_s"] for run in runs],
        "pixels": pixels.shape[0] * pixels.shape[1],
        "mean_rgb": np.mean(means, axis=0).tolist(),
    }


def _reference(renderer: Renderer, task: dict[str, Any]) -> dict[str, Any]:
    """Mean of as many chunks as reach the wanted samples per pixel, each with its own seed."""
    total: Any = 0.0
    taken, chunk, started = 0.0, 0, time.perf_counter()
    while taken < task["spp"]:
        spp = renderer.render(min(task["chunk"], int(np.ceil(task["spp"] - taken))), task["seed"] + chunk)
        total = total + renderer.image().astype(np.float64) * spp
        taken, chunk = taken + spp, chunk + 1
    mean = total / taken
    np.save(f"{task['images']}.npy", mean.astype(np.float32))
    return {"spp": taken, "render_s": [time.perf_counter() - started], "mean_rgb": mean.mean(axis=(0, 1)).tolist()}


def _watch_memory(renderer: Renderer, task: dict[str, Any]) -> dict[str, Any]:
    """Resident bytes in the last quarter of a render (median), when the scene is in place, and the peak so far."""
    resident: list[int] = []
    done = threading.Event()

    def watch() -> None:
        while not done.wait(WATCH_EVERY_S):
            resident.append(_memory("VmRSS"))

    watcher = threading.Thread(target=watch)
    watcher.start()
    renderer.render(task["spp"], task["seed"])
    done.set()
    watcher.join()
    resident.append(_memory("VmRSS"))
    late = resident[len(resident) * 3 // 4 :]
    peak = max(_memory("VmHWM"), *resident)
    return {"resident_bytes": int(np.median(late)), "peak_bytes": peak, "observations": len(resident)}


def _write(renderer: Renderer, task: dict[str, Any]) -> dict[str, Any]:
    taken = renderer.render(task["spp"], task["seed"])
    renderer.write(f"{task['images']}.exr")
    return {"spp": taken}


def _memory(key: str) -> int:
    """Bytes of ``VmRSS`` (now) or ``VmHWM`` (peak) of this process. getrusage would count what forked us as well."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith(key + ":"):
            return int(line.split()[1]) * 1024
    raise KeyError(key)
