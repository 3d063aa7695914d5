"""The figures of merit: samples per second, relative mean squared error, efficiency."""

from collections.abc import Sequence
from statistics import fmean, median
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks import settings

Image = NDArray[np.float32]
LUMINANCE = np.array([0.2126729, 0.7151522, 0.0721750])
"""Y of linear Rec.709."""


def samples_per_second(answer: dict[str, Any]) -> dict[str, float]:
    """From a driver's answer: camera samples per second of a whole call, and of the samples after a call's first.

    ``marginal`` leaves out what every call costs anew (scene preparation, set-up): N (spp - 1) / (t(spp) - t(1)).
    ``per_cpu_second`` divides by processor time instead, which other load on the machine disturbs less.
    """
    run = answer["passes"][0]
    samples, seconds = run["spp"] * run["pixels"], median(run["render_s"])
    rates = {"whole": samples / seconds, "per_cpu_second": samples / median(run["cpu_s"])}
    if seconds > answer["one_spp_s"]:
        rates["marginal"] = (samples - run["pixels"]) / (seconds - answer["one_spp_s"])
    return rates


def common_scale(reference: Image) -> float:
    """Factor that gives ``reference`` (H, W, 3) the luminance of ``settings.REFERENCE_MEAN_RGB``."""
    target = float(LUMINANCE @ np.array(settings.REFERENCE_MEAN_RGB))
    return target / float(LUMINANCE @ reference.mean(axis=(0, 1), dtype=np.float64))


def relative_mse(images: Sequence[Image], reference: Image) -> float:
    """Mean over pixels, channels and images of (x - ref)^2 / (ref^2 + 0.01), all scaled by ``common_scale``."""
    scale = common_scale(reference)
    scaled = reference.astype(np.float64) * scale
    weight = 1 / (scaled**2 + settings.RELATIVE_MSE_OFFSET)
    return fmean(float(np.mean((image * scale - scaled) ** 2 * weight)) for image in images)


def efficiency(relative_error: float, seconds: float) -> float:
    """1 / (relMSE * seconds): twice the efficiency is the same error in half the time."""
    return 1 / (relative_error * seconds)
