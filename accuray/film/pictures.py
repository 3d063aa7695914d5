"""Pictures from any source that can be compared: AccuRay's own EXR files, other EXR files, PNG files, arrays."""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .colour import srgb_decode
from .errors import ImageError
from .exr import has_state, read_rgb
from .image import Image
from .png_reading import read_png

Source: TypeAlias = str | os.PathLike[str] | Image | ArrayLike
EXTENSIONS = (".exr", ".png")

_CODES = 65535


@dataclass(frozen=True)
class Picture:
    """What can be compared.

    Attributes:
        name: the file's, or what it is.
        rgb: (height, width, 3) float64, linear Rec.709, premultiplied by alpha, finite.
        exposed: whether the exposure for display is already in it, as in a PNG file.
        exposure: what its maker exposes it by for display, in EV; None: unknown.
        error: standard error of rgb, of the same shape, or None.
        replicates: how many the error was estimated from.
        seed: of its samples; None: unknown.
        samples: ranges (first, end) of the numbers of its samples.
        window: which pixels (x0, y0, x1, y1) of a larger picture it shows; None: it is whole, or nobody knows.
    """

    name: str
    rgb: NDArray[np.float64]
    exposed: bool = False
    exposure: float | None = None
    error: NDArray[np.float64] | None = None
    replicates: int = 0
    seed: object = None
    samples: tuple[tuple[int, int], ...] = ()
    window: tuple[int, int, int, int] | None = None

    def shares_samples(self, other: Picture) -> bool:
        """Whether samples of one seed and number are in both, so that their noise is not independent."""
        if self.seed is None or self.seed != other.seed:
            return False
        return any(max(a, c) < min(b, d) for a, b in self.samples for c, d in other.samples)


def picture_of(source: Source, name: str) -> Picture:
    """The picture of an image, an array (height, width, 3) of linear Rec.709, or a file.

    Args:
        source: what to read.
        name: what to call it where it is no file.

    Raises:
        ImageError: a file that cannot be read, or pixels that are not finite or not (height, width, 3).
    """
    if isinstance(source, str | os.PathLike):
        picture = _from_file(source)
    elif isinstance(source, Image):
        picture = _from_image(source, name)
    else:
        picture = Picture(name, np.asarray(source, dtype=np.float64))
    rgb = picture.rgb
    if rgb.ndim != 3 or rgb.shape[2] != 3 or rgb.size == 0:
        raise ImageError(f"{picture.name}: its shape is {rgb.shape}, and (height, width, 3) is needed")
    if bad := np.count_nonzero(~np.isfinite(rgb).all(axis=2)):
        raise ImageError(f"{picture.name}: {bad} pixels are not finite: nothing can be compared with them")
    return picture


def _from_file(path: str | os.PathLike[str]) -> Picture:
    name = os.fspath(path)
    extension = Path(path).suffix.lower()
    if extension == ".png":
        encoded, alpha = read_png(path)
        linear = _decode_table()[np.rint(encoded * _CODES).astype(np.uint16)]
        return Picture(name, linear if alpha is None else linear * alpha[:, :, None], exposed=True)
    if extension != ".exr":
        raise ImageError(f"unknown image extension {extension!r}: allowed are {', '.join(EXTENSIONS)}", path)
    if has_state(path):
        return _from_image(Image.load(path), name)
    return Picture(name, read_rgb(path).astype(np.float64))


def _from_image(image: Image, name: str) -> Picture:
    return Picture(
        name,
        np.asarray(image, dtype=np.float64),
        exposure=float(image.metadata.get("exposure") or 0.0),
        error=image.error.astype(np.float64),
        replicates=image.film.replicates,
        seed=image.metadata.get("seed"),
        samples=tuple((r.first, r.end) for r in image.film.coverage),
        window=image.film.window,
    )


@lru_cache(maxsize=1)
def _decode_table() -> NDArray[np.float64]:
    """Linear values of 16-bit sRGB codes; a code k of 8 bits is 257 k of 16."""
    return np.array([srgb_decode(code / _CODES) for code in range(_CODES + 1)])
