"""The ledger: what a file's sums are and which samples of which scene they contain, as JSON text.

The text is canonical (sorted keys, no spaces, shortest round-trip numbers), so equal ledgers are equal bytes.
"""

from __future__ import annotations

import base64
import json
import math
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .coverage import Mask, SampleRange
from .errors import ImageError
from .film import Film

FORMAT = 1
"""Version of the state's format. Readers refuse a higher one; a change that old readers would misread raises it."""

_MASK_LIMIT = 1 << 28
"""Most values a mask may have: 16384 x 16384 pixels."""


@dataclass(frozen=True)
class Ledger:
    """The decoded ledger; fields as in `Film`, and the image's metadata."""

    replicates: int
    channels: tuple[str, ...]
    step: float
    width: int
    height: int
    window: tuple[int, int, int, int]
    coverage: list[SampleRange]
    metadata: dict[str, Any]


def plain(value: object, where: str = "metadata") -> Any:
    """The value in JSON's own types, so that it survives a round trip: tuples become lists, numpy scalars numbers.

    Raises:
        ImageError: a type or a non-finite number that JSON cannot hold, named by its key path.
    """
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, Mapping):
        return {str(key): plain(item, f"{where}.{key}") for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item, f"{where}[{index}]") for index, item in enumerate(value)]
    if isinstance(value, float) and not math.isfinite(value):
        raise ImageError(f"{where}: {value!r} is not a finite number")
    if value is None or isinstance(value, bool | int | float | str):
        return value
    raise ImageError(f"{where}: a {type(value).__name__} cannot be stored: allowed are numbers, text, lists and dicts")


def encode(film: Film, metadata: Mapping[str, object]) -> str:
    """The ledger of a film as ASCII JSON."""
    ledger = {
        "format": FORMAT,
        "replicates": film.replicates,
        "channels": film.channels,
        "step": film.step.hex(),
        "size": [film.width, film.height],
        "window": film.window,
        "coverage": [_encode_range(r) for r in film.coverage],
        "dropped": film.dropped_total,
        "metadata": plain(metadata),
    }
    return json.dumps(ledger, sort_keys=True, separators=(",", ":"), allow_nan=False)


def _encode_range(r: SampleRange) -> list[object]:
    if r.mask is None:
        return [r.first, r.end]
    bits = zlib.compress(np.packbits(r.mask).tobytes(), 9)
    return [r.first, r.end, {"shape": r.mask.shape, "zlib": base64.b64encode(bits).decode("ascii")}]


def check_format(version: int) -> None:
    """Raises ImageError for a format of the state that this version cannot read."""
    if version > FORMAT:
        raise ImageError(f"its state has format {version}, written by a newer AccuRay: this one reads up to {FORMAT}")
    if version < 1:
        raise ImageError(f"is damaged: its state has format {version}")


def decode(text: str) -> Ledger:
    """The ledger from its text.

    Raises:
        ImageError: not JSON, a newer format, or a field that is missing or malformed.
    """
    try:
        data = json.loads(text)
        check_format(int(data["format"]))
        width, height = (int(v) for v in data["size"])
        x0, y0, x1, y1 = (int(v) for v in data["window"])
        return Ledger(
            replicates=int(data["replicates"]),
            channels=tuple(str(name) for name in data["channels"]),
            step=float.fromhex(data["step"]),
            width=width,
            height=height,
            window=(x0, y0, x1, y1),
            coverage=[_decode_range(entry) for entry in data["coverage"]],
            metadata=dict(data["metadata"]),
        )
    except ImageError:
        raise
    except (ValueError, TypeError, KeyError, AttributeError, OverflowError, RecursionError, zlib.error) as error:
        raise ImageError(f"its ledger is damaged ({type(error).__name__}: {error})") from error


def _decode_range(entry: list[Any]) -> SampleRange:
    mask: Mask | None = None
    if len(entry) > 2:
        height, width = (int(v) for v in entry[2]["shape"])
        if height < 1 or width < 1 or height * width > _MASK_LIMIT:
            raise ValueError(f"mask of {height} x {width}")
        size = -(-height * width // 8)
        bits = zlib.decompressobj().decompress(base64.b64decode(entry[2]["zlib"], validate=True), size)
        mask = np.unpackbits(np.frombuffer(bits, dtype=np.uint8), count=height * width).reshape(height, width) != 0
    return SampleRange(int(entry[0]), int(entry[1]), mask)
