"""NVIDIA's run-time compiler, called through ctypes: the kernels must be device code even where there is no GPU."""

from __future__ import annotations

import ctypes
import functools
import importlib.util
import re
from dataclasses import dataclass
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2] / "src"
OPTIONS = ("--std=c++20", "-default-device", "--gpu-architecture=sm_90", "--fmad=false", "--ptxas-options=-v")


@dataclass(frozen=True)
class Build:
    """What a compilation gave: the cubin, and what ptxas said of the kernel."""

    cubin: bytes
    log: str

    @property
    def stack(self) -> int:
        """Bytes of local memory of the whole call tree of the deepest kernel; -1 where it cannot be bounded."""
        if "cannot be statically determined" in self.log:
            return -1
        frames = [int(n) for n in re.findall(r"(\d+) bytes stack frame", self.log)]
        cumulative = [int(n) for n in re.findall(r"(\d+) bytes cumulative stack size", self.log)]
        return max([*frames, *cumulative])

    @property
    def registers(self) -> int:
        """Registers of the kernel."""
        return max(int(n) for n in re.findall(r"Used (\d+) registers", self.log))

    @property
    def compile_seconds(self) -> float:
        """What ptxas says its part took."""
        return sum(float(ms) for ms in re.findall(r"Compile time = ([\d.]+) ms", self.log)) / 1000.0


def library() -> ctypes.CDLL:
    """The library of the package nvidia-cuda-nvrtc."""
    spec = importlib.util.find_spec("nvidia")
    folders = spec.submodule_search_locations if spec is not None else None
    assert folders, "the test group's nvidia-cuda-nvrtc is not installed"
    for folder in folders:
        for path in sorted(Path(folder).rglob("libnvrtc.so*")):
            return ctypes.CDLL(str(path))
    raise AssertionError("nvidia-cuda-nvrtc has no libnvrtc.so")


def headers(overlay: dict[str, str] | None = None) -> dict[str, bytes]:
    """Every kernel header by the name it is included by; ``overlay`` adds or replaces some."""
    found = {str(path.relative_to(SOURCE)): path.read_bytes() for path in (SOURCE / "kernels").rglob("*.h")}
    found.update({name: text.encode() for name, text in (overlay or {}).items()})
    return found


def compile_kernel(source: str, overlay: dict[str, str] | None = None) -> Build:
    """Builds a kernel for sm_90, once a run of the tests. Raises AssertionError with the compiler's log."""
    return _compile(source, tuple(headers(overlay).items()))


@functools.cache
def _compile(source: str, files: tuple[tuple[str, bytes], ...]) -> Build:
    lib = library()
    included = dict(files)
    contents = (ctypes.c_char_p * len(included))(*included.values())
    names = (ctypes.c_char_p * len(included))(*(name.encode() for name in included))
    program = ctypes.c_void_p()
    status = lib.nvrtcCreateProgram(
        ctypes.byref(program), source.encode(), b"kernel.cu", len(included), contents, names
    )
    assert status == 0, f"nvrtcCreateProgram: {status}"
    options = (ctypes.c_char_p * len(OPTIONS))(*(option.encode() for option in OPTIONS))
    status = lib.nvrtcCompileProgram(program, len(OPTIONS), options)
    log = _fetch(lib, program, "ProgramLog").decode()
    assert status == 0, log
    cubin = _fetch(lib, program, "CUBIN")
    lib.nvrtcDestroyProgram(ctypes.byref(program))
    return Build(cubin, log)


def _fetch(lib: ctypes.CDLL, program: ctypes.c_void_p, what: str) -> bytes:
    size = ctypes.c_size_t()
    assert getattr(lib, f"nvrtcGet{what}Size")(program, ctypes.byref(size)) == 0
    buffer = ctypes.create_string_buffer(size.value)
    assert getattr(lib, f"nvrtcGet{what}")(program, buffer) == 0
    return buffer.raw
