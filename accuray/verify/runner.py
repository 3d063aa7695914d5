"""Running the cases: how many samples each needs, and what comes out of it."""

from __future__ import annotations

import time
import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from accuray.verify import cameras, direct, enclosures, energy, fresnel, motion, refraction, sky, spectra
from accuray.verify.case import POWER, Case, FloatArray, Row
from accuray.verify.report import Report

#: (rows done, cases done, cases in all) after every case
ProgressCallback = Callable[[Sequence[Row], int, int], None]

CHAPTERS = {
    "C1": direct,
    "C2": enclosures,
    "C3": energy,
    "C4": fresnel,
    "C5": refraction,
    "C7": cameras,
    "C7, motion": motion,
    "C8": spectra,
    "C9": sky,
}


@dataclass(frozen=True)
class Effort:
    """How hard to try: the standard error aimed at, relative to the answer, and the most paths for one case."""

    target: float
    most_samples: int


QUICK = Effort(0.7 * POWER, 40_000_000)
THOROUGH = Effort(0.2 * POWER, 300_000_000)


def all_cases() -> list[Case]:
    """Every case of every chapter, in order."""
    return [case for chapter in CHAPTERS.values() for case in chapter.cases()]


def run(
    quick: bool = False,
    progress: ProgressCallback | None = None,
    *,
    seed: int = 0,
    only: Callable[[Case], bool] | None = None,
) -> Report:
    """Measure every case (those that `only` accepts) and report.

    `quick` aims at the power that the rules ask for and skips cases marked as long; otherwise five times the
    precision. Equal `seed` and build give equal numbers.
    """
    effort = QUICK if quick else THOROUGH
    chosen = [case for case in all_cases() if (case.quick or not quick) and (only is None or only(case))]
    rows: list[Row] = []
    started = time.perf_counter()
    for done, case in enumerate(chosen, start=1):
        rows += measure(case, effort, seed)
        if progress is not None:
            progress(tuple(rows), done, len(chosen))
    return Report(tuple(rows), quick, seed, time.perf_counter() - started)


def measure(case: Case, effort: Effort, seed: int = 0) -> list[Row]:
    """The rows of one case.

    A first run of `start` batches tells the noise. If it is too noisy, a second run with fresh seeds and as many
    batches as the noise of the first asks for replaces it, so the number that is judged never decided its own length.
    """
    started = time.perf_counter()
    own_seed = (zlib.crc32(case.id.encode()) + 2 * seed) % 2**32
    count = case.probe.start
    try:
        batches = case.probe.batches(count, own_seed)
        needed = _batches_needed(case, batches, effort)
        if needed > count:
            count = needed
            batches = case.probe.batches(count, (own_seed + 1) % 2**32)
        means, errors = case.summary(batches)
        note = "" if np.isfinite(batches).all() else "some estimates are not finite"
    except (RuntimeError, ValueError, AttributeError, TypeError) as error:
        means = errors = np.full(len(case.expected), np.nan)
        note = f"{type(error).__name__}: {error}"
    seconds = time.perf_counter() - started
    samples = count * case.probe.samples_per_batch
    numbers = zip(case.labels, case.expected, means, errors, strict=True)
    return [
        Row(
            f"{case.id}[{label}]" if label else case.id,
            case.sentence,
            case.source,
            expected,
            float(mean),
            float(error),
            samples,
            seconds / len(case.expected),
            note,
            case.tolerance,
        )
        for label, expected, mean, error in numbers
    ]


def _batches_needed(case: Case, batches: FloatArray, effort: Effort) -> int:
    """Batches that bring every number of the case to the error aimed at, a third more for safety, within the limit."""
    _, errors = case.summary(batches)
    aim = effort.target * np.abs(np.array(case.expected))
    known = (aim > 0.0) & np.isfinite(errors)
    if not known.any():
        return 0
    ratio = float(np.max((errors[known] / aim[known]) ** 2))
    if ratio <= 1.0:
        return len(batches)
    limit = max(len(batches), effort.most_samples // case.probe.samples_per_batch)
    return min(limit, int(np.ceil(1.3 * ratio * len(batches))))
