"""Files of a few hundred bytes that claim billions of vertices, triangles, texels or bytes."""

from __future__ import annotations

from pathlib import Path

from tests.fuzz.support import run_module

FORMATS = {
    "ply",
    "stl",
    "gltf",
    "glb",
    "png",
    "exr",
    "hdr",
    "tif",
    "tga",
    "bmp",
    "jpg",
    "film",
    "rgb",
    "decoder",
    "ies",
}


def test_every_claim_is_refused_within_little_memory(tmp_path: Path) -> None:
    """The process that reads them may take 48 MiB more than it had for the good files that they are made of."""
    answers = run_module("tests.fuzz.lies", tmp_path)[0]
    assert set(answers) == FORMATS
    accepted = [(name, number) for name, found in answers.items() for number, text in enumerate(found) if text is None]
    starved = [
        (name, number) for name, found in answers.items() for number, text in enumerate(found) if text == "MemoryError"
    ]
    assert not accepted
    assert not starved
    assert sum(len(found) for found in answers.values()) > 100
    assert max(len(text) for found in answers.values() for text in found if text) < 2000
