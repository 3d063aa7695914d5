"""EXR files: a picture for every viewer, and the exact state of the film beside it.

Part "rgba" holds float32 R, G, B, A and error.R/G/B and the uint32 sample count, and for each further layer of the film
(indirect) <layer>.R/G/B and error.<layer>.R/G/B. Part "accuray.state" holds the int64
sums as pairs of uint32 channels, r<replicate>.<channel>.lo and .hi (two's complement), and r<replicate>.dropped. A
hi or dropped channel that is zero everywhere is left out, and a reader takes it as zeros. The attribute accuray:ledger
(JSON) says what the sums contain; accuray:stateCrc32 guards ledger and sums against damage that EXR would not notice.

This is the only module that touches the OpenEXR wheel, which has no type stubs: `Any` stays in here. The wheel is
imported late, must be 3.5 or newer to write to memory, and has habits that this module hides from the others:
non-contiguous arrays are written as garbage (openexr issue 1929), a disk that is full when a file is closed goes
unnoticed, and on reading a damaged part is left out with nothing but a printed warning.
"""

from __future__ import annotations

import io
import os
import sys
import threading
import zlib
from collections.abc import Mapping
from typing import Any, TextIO, cast

import numpy as np
from numpy.typing import NDArray

from . import ledger
from .colour import CHROMATICITIES
from .errors import ImageError
from .files import atomic_write
from .film import Film

PICTURE_PART = "rgba"
STATE_PART = "accuray.state"
COMPRESSIONS = ("zip", "none")

_EXPANSION_LIMIT = 1100
"""Largest honest ratio of pixel bytes to file bytes: deflate reaches 1032."""
_TIME = "render_seconds"
_READING = threading.Lock()
"""Held while `sys.stdout` is exchanged."""


def write_exr(
    path: str | os.PathLike[str],
    film: Film,
    metadata: Mapping[str, Any],
    picture: Mapping[str, NDArray[Any]],
    *,
    compression: str = "zip",
    omit_time: bool = False,
) -> None:
    """Writes film and picture, atomically. Equal arguments give equal bytes.

    Args:
        path: the final name, see `files.atomic_write`.
        film: goes to the state part, exactly.
        metadata: goes to the ledger and the header; `render_seconds` goes to accuray:renderTime alone, so that two
            runs of the same work differ in those eight bytes only.
        picture: channel name to (height, width) array of the first part, float32 or uint32.
        compression: "zip" (picture ZIP, state RLE: quick to write, lossless) or "none".
        omit_time: leaves accuray:renderTime out.

    Raises:
        ImageError: unknown compression, metadata that cannot be stored, or a failure to write.
    """
    if compression not in COMPRESSIONS:
        raise ImageError(f"EXR compression {compression!r} is unknown: allowed are {', '.join(COMPRESSIONS)}")
    import OpenEXR

    timeless = {key: value for key, value in metadata.items() if key != _TIME}
    text = ledger.encode(film, timeless)
    state = _state_channels(film)
    header = _window_header(film, OpenEXR.scanlineimage) | _metadata_header(film, metadata, omit_time)
    header["accuray:ledger"] = text
    header["compression"] = OpenEXR.ZIP_COMPRESSION if compression == "zip" else OpenEXR.NO_COMPRESSION
    state_header = _window_header(film, OpenEXR.scanlineimage)
    state_header["accuray:stateFormat"] = ledger.FORMAT
    state_header["accuray:stateCrc32"] = _checksum(text, state)
    state_header["compression"] = OpenEXR.RLE_COMPRESSION if compression == "zip" else OpenEXR.NO_COMPRESSION
    parts = [
        OpenEXR.Part(header, {name: np.ascontiguousarray(plane) for name, plane in picture.items()}, PICTURE_PART),
        OpenEXR.Part(state_header, dict(state), STATE_PART),
    ]
    file = io.BytesIO()
    OpenEXR.File(parts).write(file)
    atomic_write(path, file.getbuffer())


def _window_header(film: Film, storage: Any) -> dict[str, Any]:
    """Storage type and the two windows; EXR's boxes include their last pixel."""
    x0, y0, x1, y1 = film.window
    return {
        "type": storage,
        "dataWindow": (np.array([x0, y0], np.int32), np.array([x1 - 1, y1 - 1], np.int32)),
        "displayWindow": (np.array([0, 0], np.int32), np.array([film.width - 1, film.height - 1], np.int32)),
        "chromaticities": CHROMATICITIES,
    }


def _metadata_header(film: Film, metadata: Mapping[str, Any], omit_time: bool) -> dict[str, Any]:
    """The attributes that tools show. Whole numbers are text, since they may exceed EXR's 32-bit int."""
    first = min((r.first for r in film.coverage), default=0)
    header: dict[str, Any] = {
        "accuray:version": _text(metadata.get("version", "")),
        "accuray:sceneHash": _text(metadata.get("scene_hash", "")),
        "accuray:seed": _text(metadata.get("seed", "")),
        "accuray:sampleStart": str(first),
        "accuray:sampleCount": str(sum(r.end - r.first for r in film.coverage)),
        "accuray:cmd": _text(metadata.get("command", "")),
        "accuray:dropped": str(film.dropped_total),
    }
    if metadata.get("white_balance") is not None:
        header["accuray:whiteBalance"] = np.array(metadata["white_balance"], dtype=np.float64)
    if metadata.get("exposure") is not None:
        header["accuray:exposure"] = float(metadata["exposure"])
    if metadata.get(_TIME) is not None and not omit_time:
        header["accuray:renderTime"] = np.array([metadata[_TIME]], dtype=np.float64)
    return header


def _text(value: object) -> str:
    """Text that UTF-8 can hold: undecodable bytes of a command line are escaped."""
    return str(value).encode("utf-8", "backslashreplace").decode("utf-8")


def _names(replicates: int, channels: tuple[str, ...]) -> list[str]:
    """Names of the 64-bit state channels, in the order of the film's last two axes."""
    return [f"r{r}.{channel}" for r in range(replicates) for channel in channels]


def _state_channels(film: Film) -> dict[str, NDArray[np.uint32]]:
    """The uint32 channels (height, width) of the state; hi and dropped only where they are not zero everywhere."""
    h, w = film.shape
    words = film.sums.astype("<i8", copy=False).view("<u4").reshape(h, w, -1, 2)
    planes = np.ascontiguousarray(words.transpose(2, 3, 0, 1))
    channels: dict[str, NDArray[np.uint32]] = {}
    for name, (low, high) in zip(_names(film.replicates, film.channels), planes, strict=True):
        channels[f"{name}.lo"] = low
        if high.any():
            channels[f"{name}.hi"] = high
    for r in range(film.replicates):
        if film.dropped[:, :, r].any():
            channels[f"r{r}.dropped"] = np.ascontiguousarray(film.dropped[:, :, r])
    return channels


def _checksum(text: str, state: Mapping[str, NDArray[np.uint32]]) -> str:
    """CRC-32 of the ledger's text and of the state channels with their names, eight hexadecimal digits."""
    crc = zlib.crc32(text.encode("utf-8", "surrogatepass"))
    for name in sorted(state):
        plane = np.ascontiguousarray(state[name], dtype="<u4")
        crc = zlib.crc32(plane.data, zlib.crc32(name.encode(), crc))
    return f"{crc:08x}"


def read_exr(path: str | os.PathLike[str]) -> tuple[Film, dict[str, Any]]:
    """The film and the metadata of a file that `write_exr` wrote, exactly.

    Raises:
        ImageError: names the path and says whether the file is missing, no EXR, an EXR without AccuRay's state, of a
            newer format, truncated or damaged.
    """
    try:
        return _read(os.fspath(path))
    except ImageError as error:
        raise ImageError(error.reason, path) from error.__cause__


def _read(path: str) -> tuple[Film, dict[str, Any]]:
    size = _check_is_exr(path)
    headers = _headers(path)
    if STATE_PART not in headers or PICTURE_PART not in headers:
        raise ImageError(f"is an EXR without AccuRay's state (part {STATE_PART}): it can be viewed, not loaded")
    text = _attribute(headers[PICTURE_PART], "accuray:ledger", str)
    ledger.check_format(_attribute(headers[STATE_PART], "accuray:stateFormat", int))
    record = ledger.decode(text)
    for header in headers.values():
        _check_geometry(header, record, size)
    stored = {channel.name for channel in headers[STATE_PART]["channels"]}
    if missing := {f"{name}.lo" for name in _names(record.replicates, record.channels)} - stored:
        raise ImageError(f"is damaged: its state lacks {len(missing)} channels")
    state = _state_planes(path)
    if _checksum(text, state) != _attribute(headers[STATE_PART], "accuray:stateCrc32", str):
        raise ImageError("is damaged: the checksum of its state does not match")
    metadata = dict(record.metadata)
    time = headers[PICTURE_PART].get("accuray:renderTime")
    if isinstance(time, np.ndarray) and time.size == 1:
        metadata[_TIME] = float(time[0])
    return _film(record, state), metadata


def has_state(path: str | os.PathLike[str]) -> bool:
    """Whether an EXR file holds AccuRay's state, so that `read_exr` can read it.

    Raises:
        ImageError: as `read_exr`, but for the state.
    """
    try:
        return STATE_PART in _headers(os.fspath(path))
    except ImageError as error:
        raise ImageError(error.reason, path) from error.__cause__


def read_rgb(path: str | os.PathLike[str]) -> NDArray[np.float32]:
    """The linear Rec.709 pixels (height, width, 3) of any EXR file's data window, whoever wrote it.

    They are the channels R, G and B of the first part that has them, or the first layer's (`beauty.R`, ...).

    Raises:
        ImageError: the file is missing, no EXR, truncated, damaged, or holds no such channels or other primaries.
    """
    try:
        return _read_rgb(os.fspath(path))
    except ImageError as error:
        raise ImageError(error.reason, path) from error.__cause__


def _read_rgb(path: str) -> NDArray[np.float32]:
    size = _check_is_exr(path)
    for header in _headers(path).values():
        _check_expansion(header, size)
        _check_primaries(header)
    parts, complaint = _open(path, header_only=False)
    names = [name for part in parts for name in part.channels]
    for part in parts:
        for layer in sorted(name.removesuffix("R") for name in part.channels if name == "R" or name.endswith(".R")):
            planes = [part.channels[layer + colour].pixels for colour in "RGB" if layer + colour in part.channels]
            if len(planes) == 3 and len({plane.shape for plane in planes}) == 1:
                return np.stack(planes, axis=2).astype(np.float32)
    problem = f"its pixels cannot be decoded ({complaint})" if complaint else f"it has {', '.join(names) or 'none'}"
    raise ImageError(f"has no channels R, G and B of one size: {problem}")


def _check_primaries(header: Mapping[str, Any]) -> None:
    """Refuses colours of another space; where nothing is said they are Rec.709, as the format has it."""
    given = header.get("chromaticities")
    if given is not None and not np.allclose(np.asarray(given, dtype=np.float64), CHROMATICITIES, atol=2e-3):
        raise ImageError(f"has other primaries than Rec.709: chromaticities {', '.join(f'{v:g}' for v in given)}")


def _headers(path: str) -> dict[Any, Any]:
    """The headers of the parts by their names."""
    _check_is_exr(path)
    return {part.header.get("name"): part.header for part in _open(path, header_only=True)[0]}


def _check_is_exr(path: str) -> int:
    """The size of the file in bytes, after a look at its first four."""
    try:
        with open(path, "rb") as file:
            magic = file.read(4)
            size = os.fstat(file.fileno()).st_size
    except OSError as error:
        raise ImageError(f"cannot be read: {error.strerror}") from error
    except ValueError as error:
        raise ImageError(f"cannot be read: {error}") from error
    if magic != b"\x76\x2f\x31\x01":
        raise ImageError("is not an EXR file" if magic else "is empty, not an EXR file")
    return size


def _open(path: str, *, header_only: bool) -> tuple[list[Any], str]:
    """The parts of the file that can be decoded, and what the wheel prints about the others."""
    import OpenEXR

    with _READING, _Heard() as heard:
        try:
            return list(OpenEXR.File(path, separate_channels=True, header_only=header_only).parts), heard.text()
        except (
            RuntimeError,
            ValueError,
            TypeError,
            KeyError,
            IndexError,
            MemoryError,
            OverflowError,
            OSError,
        ) as error:
            raise ImageError(f"is not a readable EXR file: truncated or damaged ({error})") from error


class _Heard:
    """While entered, collects what this thread prints instead of printing it; other threads print as ever."""

    def __enter__(self) -> _Heard:
        self._thread = threading.get_ident()
        self._stdout = sys.stdout
        self._parts: list[str] = []
        sys.stdout = cast(TextIO, self)
        return self

    def __exit__(self, *_: object) -> None:
        sys.stdout = self._stdout

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stdout, name)

    def write(self, text: str) -> int:
        """Collects or passes on."""
        if threading.get_ident() != self._thread:
            return self._stdout.write(text)
        self._parts.append(text)
        return len(text)

    def text(self) -> str:
        """What was collected, in one line."""
        return " ".join("".join(self._parts).split())


def _attribute(header: Mapping[str, Any], name: str, kind: type[Any]) -> Any:
    value = header.get(name)
    if not isinstance(value, kind):
        raise ImageError(f"is damaged: its attribute {name} is missing or no {kind.__name__}")
    return value


def _check_geometry(header: Mapping[str, Any], record: ledger.Ledger, size: int) -> None:
    """Refuses a data window other than the ledger's, and pixels that cannot fit a file of `size` bytes."""
    (x0, y0), (x1, y1) = header["dataWindow"]
    window = (int(x0), int(y0), int(x1) + 1, int(y1) + 1)
    if window != record.window:
        raise ImageError(f"is damaged: its data window {window} is not the ledger's {record.window}")
    _check_expansion(header, size)


def _check_expansion(header: Mapping[str, Any], size: int) -> None:
    """Refuses pixels that cannot fit a file of `size` bytes."""
    (x0, y0), (x1, y1) = header["dataWindow"]
    declared = (int(x1) + 1 - int(x0)) * (int(y1) + 1 - int(y0)) * len(header["channels"]) * 4
    if declared > size * _EXPANSION_LIMIT:
        raise ImageError(f"is damaged: it declares {declared} bytes of pixels in a file of {size} bytes")


def _state_planes(path: str) -> dict[str, NDArray[np.uint32]]:
    """The channels stored in the state part."""
    parts, complaint = _open(path, header_only=False)
    for part in parts:
        if part.header.get("name") == STATE_PART:
            return {name: channel.pixels for name, channel in part.channels.items()}
    raise ImageError(f"is truncated or damaged: its state cannot be decoded ({complaint})")


def _film(record: ledger.Ledger, state: dict[str, NDArray[np.uint32]]) -> Film:
    """The film from its ledger and state channels."""
    x0, y0, x1, y1 = record.window
    h, w = y1 - y0, x1 - x0
    sums = np.zeros((h, w, record.replicates, len(record.channels)), dtype=np.int64)
    dropped = np.zeros(sums.shape[:3], dtype=np.uint32)
    words = sums.view("<u4").reshape(h, w, -1, 2)
    targets = {f"r{r}.dropped": dropped[:, :, r] for r in range(record.replicates)}
    for index, name in enumerate(_names(record.replicates, record.channels)):
        targets[f"{name}.lo"] = words[:, :, index, 0]
        targets[f"{name}.hi"] = words[:, :, index, 1]
    for name, plane in state.items():
        if name not in targets or plane.shape != (h, w) or plane.dtype != np.uint32:
            raise ImageError(f"is damaged: unexpected state channel {name}")
        targets[name][...] = plane
    return Film(
        sums, dropped, record.step, record.coverage, record.window, record.width, record.height, record.channels
    )
