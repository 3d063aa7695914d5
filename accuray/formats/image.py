"""Image files for textures, through OpenImageIO, which is imported when the first one is read."""

from __future__ import annotations

from pathlib import Path
from tempfile import NamedTemporaryFile
from typing import Any

import numpy as np
from numpy.typing import NDArray

from accuray.scene.images import MAX_BYTES, check_size
from accuray.scene.paths import display_path

_STORED = {"uint8": "uint8", "uint16": "uint16", "half": "half"}
"""Types that are kept as they are; all others are read as single precision floats."""

_MOST_EXPANSION = 1100
_ALWAYS_ALLOWED = 16 << 20
"""Largest honest ratio of texels to file in bytes (deflate and JPEG reach a thousand), and bytes of texels that need
none: a header of a few bytes must not take more memory than that."""


def read(path: Path) -> NDArray[Any]:
    """(height, width, channels) of uint8, uint16, float16 or float32, from the top, as ``ImageReader`` says.

    The first picture of the file is read, and at most four of its channels; colours stay as they are stored, not
    multiplied by alpha. Raises ValueError.
    """
    import OpenImageIO as oiio  # noqa: N813

    oiio.attribute("limits:imagesize_MB", MAX_BYTES >> 20)
    config = oiio.ImageSpec()
    config.attribute("oiio:UnassociatedAlpha", 1)
    source = oiio.ImageInput.open(str(path), config)
    if source is None:
        raise ValueError(_message(oiio.geterror(), path))
    try:
        return _read(source, path)
    finally:
        source.close()
        oiio.geterror()


def read_bytes(content: bytes, suffix: str) -> NDArray[Any]:
    """As ``read``, from the content of a file with this suffix (".png"). Raises ValueError."""
    with NamedTemporaryFile(suffix=suffix) as file:
        file.write(content)
        file.flush()
        try:
            return read(Path(file.name))
        except ValueError as error:
            raise ValueError(str(error).replace(display_path(Path(file.name)), "the picture")) from None


def write(path: Path, pixels: NDArray[Any]) -> None:
    """Writes (height, width, channels) as PNG (uint8, uint16) or OpenEXR (float16, float32). Raises OSError."""
    import OpenImageIO as oiio  # noqa: N813

    height, width, channels = pixels.shape
    kinds = {"uint8": oiio.UINT8, "uint16": oiio.UINT16, "float16": oiio.HALF, "float32": oiio.FLOAT}
    spec = oiio.ImageSpec(width, height, channels, kinds[pixels.dtype.name])
    spec.attribute("oiio:UnassociatedAlpha", 1)
    target = oiio.ImageOutput.create(str(path))
    if target is None or not target.open(str(path), spec) or not target.write_image(pixels):
        raise OSError(_message(oiio.geterror() if target is None else target.geterror(), path))
    target.close()


def _read(source: Any, path: Path) -> NDArray[Any]:
    spec = source.spec()
    if spec.depth > 1:
        raise ValueError(f"it is a volume of {spec.depth} slices; allowed are flat pictures")
    if spec.deep:
        raise ValueError("it is a deep image; allowed are flat pictures")
    kind = _STORED.get(str(spec.format), "float")
    channels = min(spec.nchannels, 4)
    check_size(spec.width, spec.height, channels * np.dtype(kind.replace("half", "float16")).itemsize)
    _check_expansion(spec, path)
    try:
        pixels = source.read_image(0, 0, 0, channels, kind)
    except MemoryError:
        raise ValueError(f"its {spec.width} x {spec.height} texels do not fit the memory that is free") from None
    error = source.geterror()
    if pixels is None or error:
        raise ValueError(_message(error, path))
    return np.ascontiguousarray(np.reshape(pixels, (spec.height, spec.width, channels)))


def _check_expansion(spec: Any, path: Path) -> None:
    """ValueError for a picture that its file is too small to hold."""
    claimed, size = int(spec.image_bytes(native=True)), path.stat().st_size
    if claimed > max(_ALWAYS_ALLOWED, _MOST_EXPANSION * size):
        raise ValueError(
            f"it claims {spec.width} x {spec.height} texels, {claimed} bytes, in a file of {size} bytes; "
            f"allowed are {_MOST_EXPANSION} times the file, or {_ALWAYS_ALLOWED >> 20} MiB"
        )


def _message(error: str, path: Path) -> str:
    """What the library says, in one line and without the path of this machine."""
    text = " ".join(error.replace(str(path), display_path(path)).split())
    return text or "it is broken, or of no kind that OpenImageIO reads"
