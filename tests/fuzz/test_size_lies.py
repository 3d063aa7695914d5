"""Files of a few hundred bytes that claim billions of vertices, triangles, texels or bytes."""

from __future__ import annotations

from pathlib import Path

from tests.fuzz.support import run_module


def test_every_claim_is_refused_within_little_memory(tmp_path: Path) -> None:
    """The process that reads them may take 48 MiB more than it had for the good files that they are made of."""
    (answers,) = run_module("tests.fuzz.lies", tmp_path)
    assert {"ply", "stl", "glb", "png", "exr", "film", "npy"} <= set(answers)
    messages = {(name, number): text for name, found in answers.items() for number, text in enumerate(found)}
    assert len(messages) > 100
    assert not [place for place, text in messages.items() if text is None], "believed"
    assert not [place for place, text in messages.items() if text == "MemoryError"], "memory was taken for a claim"
    assert max(map(len, messages.values())) < 2000
