"""The libFuzzer targets in this folder: how they are built, and what they start from."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from tests.fuzz import readers, seeds

BUILD = seeds.REPOSITORY / "build" / "fuzz"
FLAGS = (
    *("-std=c++20", "-O1", "-g", "-fno-omit-frame-pointer", "-march=x86-64-v3", "-ffp-contract=off"),
    *("-fsanitize=address,undefined", "-fno-sanitize-recover=undefined", "-Wall", "-Wextra", "-Isrc"),
)

SEEDS: dict[str, Callable[[], Sequence[bytes]]] = {
    "obj": seeds.obj,
    "ply": seeds.ply,
    "stl": seeds.stl,
    "arrays": lambda: (bytes([7, 3]) + bytes(range(144)),),
}
TOKENS = {"obj": seeds.OBJ_TOKENS, "ply": seeds.PLY_TOKENS, "stl": seeds.STL_TOKENS, "arrays": ()}


def build(target: str) -> Path:
    """The program of a target, built again if any of its sources is newer. The readers are compiled once for all."""
    BUILD.mkdir(parents=True, exist_ok=True)
    sources = [path for path in sorted((seeds.REPOSITORY / "src/mesh").glob("*.cpp")) if "_test" not in path.name]
    headers = [*(seeds.REPOSITORY / "src/mesh").glob("*.h"), *Path(__file__).parent.glob("*.h")]
    objects = [_made(BUILD / f"{path.stem}.o", [path, *headers], "-fsanitize=fuzzer-no-link", "-c") for path in sources]
    own = Path(__file__).with_name(f"{target}.cpp")
    return _made(BUILD / f"fuzz_{target}", [own, *objects, *headers], "-fsanitize=fuzzer")


def _made(product: Path, parts: Sequence[Path], *options: str) -> Path:
    """Runs the compiler unless the product is newer than its parts."""
    if product.exists() and all(product.stat().st_mtime > part.stat().st_mtime for part in parts):
        return product
    inputs = [path for path in parts if path.suffix != ".h"]
    command = ["clang++", *FLAGS, *options, *inputs, "-o", product]
    done = subprocess.run(command, cwd=seeds.REPOSITORY, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stderr}")
    return product


def dictionary(target: str) -> bytes:
    """The words of a format for libFuzzer."""
    words = (*readers.TEXT_TOKENS, *TOKENS[target])
    return b"".join(b'"%s"\n' % b"".join(b"\\x%02x" % byte for byte in word) for word in words)
