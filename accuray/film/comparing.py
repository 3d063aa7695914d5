"""How much two pictures differ: by the measure of the original report, and by those of today."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from accuray.testing import ZResult, blocks

from .colour import exposure_scale, srgb_encode
from .errors import ImageError
from .files import atomic_write
from .flip import DEFAULT_PIXELS_PER_DEGREE, flip
from .heat import heat_map, heat_range
from .pictures import Picture, Source, picture_of
from .png import encode_codes

SIGNIFICANCE = 0.001
"""Chance that two renders of one scene are called different: each, the blocks and the totals."""
BLOCK = 8
_ANY_POWER = 1e200
"""The question is whether noise explains a difference, not whether there is little noise."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """How a picture differs from a reference.

    Display values are those of an 8-bit picture without its rounding: exposed, clamped, sRGB-encoded, 0 to 1.

    Attributes:
        name, reference: what was compared.
        width, height: in pixels.
        exposure: of the display values, in EV.
        difference: mean absolute difference of display values in R, G and B.
        accuracy: 100 less the mean of the three, in percent (AccuRay report 2014).
        largest: the largest absolute difference of a display value.
        relative_mse: mean over pixels and channels of (a - b)^2 / (b^2 + 0.01 m^2), linear, b the reference and m its
            mean: the square of what `Image.relative_error` estimates.
        psnr: peak signal-to-noise ratio of the display values in dB; infinite if they are equal.
        flip: mean of `flip_map`.
        pixels_per_degree: that FLIP was computed for.
        identical: whether all linear values are equal.
        noise: whether noise explains the difference of the linear images: a z-test over blocks of 8 x 8 pixels in R, G
            and B, and over their totals; None where it cannot be made.
        note: why `noise` is None, or what to know about it; else empty.
        difference_map: float32 (height, width), the absolute difference of display values, mean of R, G and B.
        flip_map: float32 (height, width), FLIP, 0 to 1 (Andersson et al. 2020).
    """

    name: str
    reference: str
    width: int
    height: int
    exposure: float
    difference: tuple[float, float, float]
    accuracy: float
    largest: float
    relative_mse: float
    psnr: float
    flip: float
    pixels_per_degree: float
    identical: bool
    noise: ZResult | None
    note: str
    difference_map: NDArray[np.float32]
    flip_map: NDArray[np.float32]

    def save_heat_map(self, path: str | os.PathLike[str], limit: float | None = None) -> float:
        """Writes `difference_map` in false colours as PNG: black is no difference, white `limit` or more.

        Args:
            path: its folder must exist.
            limit: the difference that is white; default: the least of 1, 0.5, 0.2, 0.1, 0.05, ... above all but one in
                a thousand pixels.

        Returns:
            The limit.

        Raises:
            ImageWriteError: the file cannot be written.
        """
        if limit is None:
            limit = heat_range(self.difference_map)
        atomic_write(path, encode_codes(heat_map(self.difference_map, limit)))
        return limit

    def to_dict(self) -> dict[str, Any]:
        """Everything but the maps as plain values for JSON; None stands for infinite."""
        z = self.noise
        return {
            "name": self.name,
            "reference": self.reference,
            "width": self.width,
            "height": self.height,
            "exposure": self.exposure,
            "difference": list(self.difference),
            "accuracy": self.accuracy,
            "largest": self.largest,
            "relative_mse": _finite(self.relative_mse),
            "psnr": _finite(self.psnr),
            "flip": self.flip,
            "pixels_per_degree": self.pixels_per_degree,
            "identical": self.identical,
            "noise": None
            if z is None
            else {
                "verdict": z.verdict,
                "reason": z.reason,
                "worst": _finite(z.worst),
                "at": list(z.at),
                "threshold": z.threshold,
                "overall": _finite(z.overall),
            },
            "note": self.note,
        }


def compare(
    image: Source,
    reference: Source,
    *,
    exposure: float | None = None,
    pixels_per_degree: float = DEFAULT_PIXELS_PER_DEGREE,
) -> Comparison:
    """How much an image differs from a reference of the same size.

    Each is an `Image`, the path of an EXR or PNG file, or an array (height, width, 3) of linear Rec.709. Error
    estimates are used where both have them: in images and EXR files that AccuRay made.

    Args:
        image: what is judged.
        reference: what it is judged by; only `relative_mse` and FLIP depend on which is which.
        exposure: for the display values, in EV; by default the reference's own, else the image's, else 0. PNG files are
            exposed already, and are taken as they are.
        pixels_per_degree: of the visual field, for FLIP; by default 67, a 4K screen 0.7 m wide at 0.7 m.

    Raises:
        ImageError: a file that cannot be read, pixels that are not finite, or pictures of different size.
        ValueError: pixels_per_degree out of range.

    Sources: mean absolute difference and accuracy as in the AccuRay report 2014; FLIP by Andersson et al. 2020.
    """
    a, b = picture_of(image, "image"), picture_of(reference, "reference")
    _check_same_view(a, b)
    if exposure is None:
        exposure = next((p.exposure for p in (b, a) if p.exposure is not None), 0.0)
    scales = [1.0 if p.exposed else exposure_scale(exposure) for p in (a, b)]
    linear_a, linear_b = (p.rgb * scale for p, scale in zip((a, b), scales, strict=True))
    shown_a, shown_b = srgb_encode(linear_a), srgb_encode(linear_b)
    absolute = np.abs(shown_a - shown_b)
    red, green, blue = (float(v) for v in absolute.mean(axis=(0, 1)))
    squared = float(np.square(absolute).mean())
    error_map = flip(np.clip(linear_b, 0.0, 1.0), np.clip(linear_a, 0.0, 1.0), pixels_per_degree)
    noise, note = _noise(a, b, scales)
    return Comparison(
        name=a.name,
        reference=b.name,
        width=a.rgb.shape[1],
        height=a.rgb.shape[0],
        exposure=exposure,
        difference=(red, green, blue),
        accuracy=100.0 * (1.0 - (red + green + blue) / 3.0),
        largest=float(absolute.max()),
        relative_mse=relative_mse(linear_a, linear_b),
        psnr=-10.0 * math.log10(squared) if squared > 0 else math.inf,
        flip=float(error_map.mean(dtype=np.float64)),
        pixels_per_degree=pixels_per_degree,
        identical=bool(np.array_equal(linear_a, linear_b)),
        noise=noise,
        note=note,
        difference_map=absolute.mean(axis=2).astype(np.float32),
        flip_map=error_map,
    )


def relative_mse(image: NDArray[np.float64], reference: NDArray[np.float64]) -> float:
    """Mean over pixels and channels of (a - b)^2 / (b^2 + 0.01 m^2), b the reference and m its mean.

    Infinite if the reference is black and the image is not.
    """
    squared = np.square(image - reference)
    scale = np.square(reference) + 0.01 * float(reference.mean()) ** 2
    ratio = np.divide(squared, scale, out=np.where(squared > 0, math.inf, 0.0), where=scale > 0)
    return float(ratio.mean())


def _check_same_view(a: Picture, b: Picture) -> None:
    """Refuses pictures of different size, and crops of different places."""
    (height_a, width_a, _), (height_b, width_b, _) = a.rgb.shape, b.rgb.shape
    if (width_a, height_a) != (width_b, height_b):
        same = width_a * height_b == width_b * height_a
        hint = "render both at one size" if same else "their shapes differ too: is one of them a crop?"
        raise ImageError(
            f"sizes differ: {a.name} has {width_a} x {height_a} pixels, {b.name} {width_b} x {height_b}; {hint}"
        )
    if a.window and b.window and a.window != b.window:
        places = (f"x {x0}:{x1}, y {y0}:{y1}" for x0, y0, x1, y1 in (a.window, b.window))
        raise ImageError(f"{a.name} and {b.name} show different parts of the picture: {' and '.join(places)}")


def _noise(a: Picture, b: Picture, scales: list[float]) -> tuple[ZResult | None, str]:
    """The z-test by the errors of both pictures, or None; and what to know about it, or why there is none."""
    if a.error is None or b.error is None:
        return None, "not both have error estimates"
    if not (np.isfinite(a.error).all() and np.isfinite(b.error).all()):
        return None, "some pixels have too few samples for an error estimate"
    columns = (a.rgb * scales[0], a.error * scales[0], b.rgb * scales[1], b.error * scales[1])
    dof = min(a.replicates, b.replicates) - 1
    note = (
        "both hold samples of one seed and number: they share noise, so less is noticed" if a.shares_samples(b) else ""
    )
    return blocks(*columns, size=BLOCK, alpha=SIGNIFICANCE, power=_ANY_POWER, dof=dof), note


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
