"""Damages image files in many ways and loads each as a texture, in a process of its own that may crash.

    python image_mutations.py FOLDER FORMAT COUNT

writes one JSON object: how many were loaded, how many refused, the longest message and the slowest load in seconds.
Before each attempt the number of the mutation goes to FOLDER/current, for the one that is the last.
"""

from __future__ import annotations

import json
import random
import resource
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import OpenImageIO as oiio  # noqa: N813

import accuray

ADDRESS_SPACE = 8 << 30
SUFFIXES = {
    "png": "uint16",
    "jpg": "uint8",
    "exr": "half",
    "hdr": "float",
    "tif": "uint8",
    "tga": "uint8",
    "bmp": "uint8",
}


def write_image(path: Path, kind: str) -> None:
    """A small picture with some structure, in the type that the format holds."""
    rows, columns = np.mgrid[0:24, 0:31]
    pixels = np.stack([rows / 23.0, columns / 30.0, (rows * columns % 7) / 6.0], axis=-1).astype(np.float32)
    output = oiio.ImageOutput.create(str(path))
    assert output.open(str(path), oiio.ImageSpec(31, 24, 3, kind)), output.geterror()
    assert output.write_image(pixels), output.geterror()
    assert output.close(), output.geterror()


def mutations(content: bytes, count: int, seed: int) -> Iterator[bytes]:
    """Truncated at even steps, then with bytes and words replaced, blocks repeated, removed and swapped."""
    generator = random.Random(seed)
    ends = count // 4
    yield from (content[: len(content) * end // ends] for end in range(ends))
    words = [
        b"\x00" * 4,
        b"\xff" * 4,
        b"\x7f\xff\xff\xff",
        b"\xff\xff\xff\x7f",
        b"\x00\x01\x00\x00",
        b"\x80\x00\x00\x00",
    ]
    for number in range(count - ends):
        damaged = bytearray(content)
        for _ in range(generator.randrange(1, 6)):
            # Two thirds of the damage lies in the head, where sizes, types and offsets are.
            at = generator.randrange(min(len(content), 160) if number % 3 else len(content))
            way = generator.randrange(4)
            if way == 0:
                damaged[at : at + 1] = bytes([generator.randrange(256)])
            elif way == 1:
                damaged[at : at + 4] = generator.choice(words)
            elif way == 2:
                del damaged[at : at + generator.randrange(1, 40)]
            else:
                damaged[at:at] = damaged[at : at + generator.randrange(1, 200)]
        yield bytes(damaged)


def main() -> None:
    folder, suffix, count = Path(sys.argv[1]), sys.argv[2], int(sys.argv[3])
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE))
    write_image(folder / f"good.{suffix}", SUFFIXES[suffix])
    content = (folder / f"good.{suffix}").read_bytes()
    found = {"loaded": 0, "refused": 0, "longest": 0, "slowest": 0.0}
    for number, damaged in enumerate(mutations(content, count, seed=len(content))):
        (folder / "current").write_text(str(number))
        (folder / f"x.{suffix}").write_bytes(damaged)
        start = time.monotonic()
        try:
            accuray.Scene.from_dict({"textures": {"t": {"type": "image", "file": f"x.{suffix}"}}}, folder=folder)
            found["loaded"] += 1
        except accuray.SceneError as error:
            found["refused"] += 1
            found["longest"] = max(found["longest"], len(str(error)))
        found["slowest"] = max(found["slowest"], time.monotonic() - start)
    print(json.dumps(found))


if __name__ == "__main__":
    main()
