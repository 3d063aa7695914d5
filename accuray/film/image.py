"""The image: a film, what is known about it, and the views people want of it."""

from __future__ import annotations

import io
import os
from collections.abc import Mapping, Sequence
from functools import cached_property, reduce
from pathlib import Path
from typing import Any, cast

import numpy as np
from numpy.typing import DTypeLike, NDArray

from .colour import Matrix, Vector, xyz_to_balanced_rgb
from .errors import ImageError, MergeError
from .estimates import RegionEstimate, pixel_estimates, region_estimate, relative_error
from .exr import read_exr, write_exr
from .files import atomic_write
from .film import Film
from .layers import Layers
from .ledger import plain
from .merging import merge
from .png import encode_png, shrink

EXTENSIONS = (".exr", ".png", ".npy")
_NOTEBOOK_WIDTH = 960
_SAME_SCENE = ("scene_hash", "seed", "sampling_version")
_SUMMED = ("render_seconds", "rays")
_SAME_LEVEL = ("version", "isa", "cpu_vendor", "mixed")


class Image:
    """A rendered image: exact sums, error bars, metadata.

    `numpy.asarray(image)` is height x width x 3 float32, linear Rec.709 with the white balance applied and without
    exposure, which is for display only (PNG). EXR files hold the same numbers, and the exact XYZ sums beside them.

    Attributes:
        film: the exact sums, raw XYZ and alpha.
        metadata: plain JSON-like values. Known keys: scene_hash (text), seed, sampling_version (int), version, isa,
            cpu_vendor, command (text), exposure (EV), white_balance ([X, Y, Z] that becomes white, or None),
            hide_environment (bool: PNG gets an alpha channel), render_seconds (float), rays (int). Others are kept.
    """

    def __init__(self, film: Film, metadata: Mapping[str, object] | None = None) -> None:
        self.film = film
        self.metadata: dict[str, Any] = plain(metadata or {})

    @property
    def height(self) -> int:
        """Height of the rendered window in pixels; the full image is `film.height` high."""
        return self.film.shape[0]

    @property
    def width(self) -> int:
        """Width of the rendered window in pixels; the full image is `film.width` wide."""
        return self.film.shape[1]

    @property
    def shape(self) -> tuple[int, int, int]:
        """(height, width, 3), the shape of `numpy.asarray(image)`."""
        return self.height, self.width, 3

    @property
    def colour_matrix(self) -> Matrix:
        """XYZ to the image's RGB, white balance included.

        Raises:
            ImageError: a white balance that is no white.
        """
        white = self.metadata.get("white_balance")
        try:
            return xyz_to_balanced_rgb(None if white is None else cast(Vector, tuple(float(v) for v in white)))
        except (TypeError, ValueError) as error:
            raise ImageError(f"metadata.white_balance: {error}") from error

    @cached_property
    def layers(self) -> Layers:
        """The layers by name, computed when asked for: see `Layers`."""
        return Layers(self.film, self.colour_matrix)

    @property
    def error(self) -> NDArray[np.float32]:
        """Standard error of R, G and B per pixel, float32 (height, width, 3); infinite where it is not known."""
        return self.layers["error"]

    @property
    def relative_error(self) -> float:
        """Estimated relative error of the RGB image, see `estimates.relative_error`."""
        return relative_error(*pixel_estimates(self.film, self.colour_matrix))

    def region(
        self, x0: int, x1: int, y0: int, y1: int, *, confidence: float = 0.95, space: str = "rgb"
    ) -> RegionEstimate:
        """Mean and confidence interval over the pixels x0 <= x < x1, y0 <= y < y1 of the full image.

        Args:
            x0: first column, in coordinates of the full image.
            x1: one past the last column.
            y0: first row.
            y1: one past the last row.
            confidence: probability of the interval, by Student's t with n (R - 1) degrees of freedom for n pixels.
            space: "rgb" (linear Rec.709, white balanced) or "xyz" (raw).

        Raises:
            ImageError: region outside the image, or unknown space.
        """
        if space not in ("rgb", "xyz"):
            raise ImageError(f"colour space {space!r} is unknown: allowed are rgb, xyz")
        matrix = self.colour_matrix if space == "rgb" else None
        return region_estimate(self.film, x0, x1, y0, y1, matrix=matrix, confidence=confidence)

    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> NDArray[Any]:
        """The RGB image; writable and independent unless copy=False, which gives a read-only view."""
        rgb = self.layers["rgb"]
        if copy is False:
            if dtype is not None and np.dtype(dtype) != rgb.dtype:
                raise ValueError(f"an image is float32: a copy is needed for {np.dtype(dtype)}")
            return rgb
        return np.array(rgb, dtype=dtype)

    def save(
        self,
        path: str | os.PathLike[str],
        *,
        exposure: float | None = None,
        layer: str = "rgb",
        compression: str = "zip",
        omit_time: bool = False,
    ) -> None:
        """Writes the image, atomically and durably; the extension decides the format.

        .exr: linear float32 with errors, sample counts, all layers and the exact state. .png: 8-bit sRGB with exposure.
        .npy: the float32 array (height, width, 3) of the layer.

        Args:
            path: its folder must exist.
            exposure: PNG only, in EV; default: the metadata's, else 0.
            layer: PNG and NPY only, "rgb" or one of `film.layers`.
            compression: EXR only, "zip" or "none".
            omit_time: EXR only, leaves the render time out, so that repeated renders give equal files.

        Raises:
            ImageError: unknown extension or layer, or something that the format cannot hold.
            ImageWriteError: the file cannot be written.
        """
        extension = Path(path).suffix.lower()
        shown = ("rgb", *self.film.layers)
        if layer not in shown:
            raise ImageError(f"layer {layer!r} is not in the image: allowed are {', '.join(shown)}", path)
        if extension == ".exr":
            picture = self._picture()
            write_exr(path, self.film, self.metadata, picture, compression=compression, omit_time=omit_time)
        elif extension == ".png":
            atomic_write(path, self._png(exposure, layer=layer))
        elif extension == ".npy":
            file = io.BytesIO()
            np.save(file, self.layers[layer])
            atomic_write(path, file.getbuffer())
        else:
            raise ImageError(f"unknown image extension {extension!r}: allowed are {', '.join(EXTENSIONS)}", path)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Image:
        """The image from an EXR file that AccuRay wrote: same film, same metadata, exactly.

        Raises:
            ImageError: the file is missing, foreign, damaged, or of a newer format.
        """
        return cls(*read_exr(path))

    @classmethod
    def merge(cls, images: Sequence[Image], *, mixed: bool = False) -> Image:
        """The exact sum of images that hold disjoint samples of one scene.

        Args:
            images: at least one, in any order; the sums do not depend on it. Metadata are the first one's, with times
                and rays added.
            mixed: allows different versions, instruction sets or processor vendors. The sums stay exact, but the
                result is no longer the bits of one machine, and its metadata say so ("mixed": True).

        Raises:
            MergeError: different scene, seed, settings or level, or a sample held twice.
            FilmOverflowError: a sum leaves 64 bits.
        """
        if not images:
            raise MergeError("no images to merge")
        metadata = dict(images[0].metadata)
        for other in images[1:]:
            _check_same(metadata, other.metadata, _SAME_SCENE, "")
            if not mixed:
                _check_same(metadata, other.metadata, _SAME_LEVEL, " (--mixed allows it)")
            elif any(metadata.get(key) != other.metadata.get(key) for key in _SAME_LEVEL):
                metadata["mixed"] = True
        for key in _SUMMED:
            values = [image.metadata[key] for image in images if image.metadata.get(key) is not None]
            if values:
                metadata[key] = sum(values)
        return cls(reduce(merge, (image.film for image in images)), metadata)

    def pixels_equal(self, other: Image) -> bool:
        """Whether window and all pixel bits that an EXR's first part holds are the same."""
        mine, theirs = self._picture(), other._picture()
        return (self.film.window, mine.keys()) == (other.film.window, theirs.keys()) and all(
            np.array_equal(mine[name].view(np.uint32), theirs[name].view(np.uint32)) for name in mine
        )

    def _picture(self) -> dict[str, NDArray[Any]]:
        """The channels of an EXR's first part; counts beyond 32 bits are held at the largest."""
        samples = np.minimum(self.layers["samples"], np.iinfo(np.uint32).max).astype(np.uint32)
        channels: dict[str, NDArray[Any]] = {"A": self.layers["alpha"], "samples": samples}
        for prefix, layer in (("", "rgb"), ("error.", "error"), *((f"{name}.", name) for name in self._further_layers)):
            for index, name in enumerate("RGB"):
                channels[prefix + name] = np.ascontiguousarray(self.layers[layer][:, :, index])
        return channels

    @property
    def _further_layers(self) -> tuple[str, ...]:
        """Names of the layers besides the colours, and of their errors."""
        return (*self.film.layers, *(f"error.{layer}" for layer in self.film.layers))

    def _png(self, exposure: float | None = None, *, layer: str = "rgb", width: int | None = None) -> bytes:
        """The PNG file, at most `width` pixels wide; exposure in EV, by default the metadata's."""
        pixels = self.layers[layer]
        if transparent := bool(self.metadata.get("hide_environment")):
            pixels = np.concatenate([pixels, self.layers["alpha"][:, :, None]], axis=2)
        if width is not None:
            pixels = shrink(pixels, width)
        ev = float(self.metadata.get("exposure") or 0.0) if exposure is None else exposure
        alpha = pixels[:, :, 3] if transparent else None
        return encode_png(pixels[:, :, :3], alpha, exposure=ev)

    def _repr_png_(self) -> bytes:
        """The PNG that notebooks show, at most 960 pixels wide."""
        return self._png(width=_NOTEBOOK_WIDTH)

    def __repr__(self) -> str:
        film = self.film
        samples = ", ".join(f"{r.first}:{r.end}" for r in film.coverage) or "none"
        return f"<accuray.Image {self.width}x{self.height} of {film.width}x{film.height}, samples {samples}>"


def _check_same(a: Mapping[str, Any], b: Mapping[str, Any], keys: Sequence[str], hint: str) -> None:
    """Raises MergeError when the two metadata differ in one of the keys."""
    for key in keys:
        if a.get(key) != b.get(key):
            raise MergeError(f"images differ in {key}: {a.get(key)!r} and {b.get(key)!r}{hint}")
