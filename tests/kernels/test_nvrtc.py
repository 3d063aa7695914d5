"""The kernels are device code: one GPU kernel that reaches every type of every list builds to an sm_90 cubin."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.kernels.nvrtc import Build, compile_kernel

KERNEL = Path(__file__).with_name("sample_pixels.cu").read_text(encoding="utf-8")
LARGEST_STACK = 1024


@pytest.fixture(scope="module")
def build() -> Build:
    return compile_kernel(KERNEL)


def test_builds_without_recursion_or_unresolved_calls(build: Build) -> None:
    assert build.cubin.startswith(b"\x7fELF")
    assert "unresolved" not in build.log, build.log
    assert "extern" not in build.log, build.log
    assert build.stack >= 0, f"the stack cannot be bounded, so something recurses:\n{build.log}"


def test_local_stack_is_small(build: Build, capsys: pytest.CaptureFixture[str]) -> None:
    with capsys.disabled():
        print(
            f"\nNVRTC sm_90: {build.registers} registers, {build.stack} B of stack, ptxas {build.compile_seconds:.1f} s"
        )
    assert build.stack <= LARGEST_STACK


RECURSION = """
#include "kernels/port.h"
__device__ __noinline__ int deep(int n, int* p) { return n <= 0 ? p[0] : deep(n - p[n], p) + deep(n - 2, p) * 3; }
extern "C" __global__ void kernel(int* p) { p[0] = deep(p[1], p); }
"""
LARGE_FRAME = """
#include "kernels/port.h"
extern "C" __global__ void kernel(int* p) {
  int a[1024];
  for (int i = 0; i < 1024; ++i) a[(i * p[1]) & 1023] = p[i];
  p[0] = a[p[2] & 1023];
}
"""


def test_recursion_is_noticed() -> None:
    assert compile_kernel(RECURSION).stack == -1


def test_a_large_frame_is_noticed() -> None:
    assert compile_kernel(LARGE_FRAME).stack > LARGEST_STACK


def test_an_unresolved_call_is_refused() -> None:
    with pytest.raises(AssertionError, match="missing"):
        compile_kernel(
            'extern "C" __device__ int missing(int);\nextern "C" __global__ void k(int* p) { *p = missing(1); }'
        )
