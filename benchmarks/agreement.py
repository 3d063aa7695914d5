"""Whether the renderers show the same scene: ``python -m benchmarks.agreement out/bench/interior-128``.

Reads the references that a run has left in a scene's folder, prints how far each is from AccuRay's, block by block,
and writes all of them side by side as ``pictures.png`` beside them. A time to equal error means something only where
the pictures agree.
"""

import argparse
import sys
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from accuray.film.colour import srgb8
from accuray.film.png import encode_codes
from benchmarks import measures, report

BLOCKS = 8
"""Along each side of the picture."""
GAP = 4
WHITE = 0.35
"""The mean luminance that the pictures get."""

COLUMNS = {
    "renderer": "renderer",
    "mean_rgb": "mean RGB|.4f",
    "whole": "whole|+.2%",
    "typical": "typical block|.2%",
    "worst": "worst block|+.2%",
    "at": "at column, row|d",
}


def newest_references(folder: Path) -> dict[str, Path]:
    """The last reference of each renderer, AccuRay's first.

    Raises:
        FileNotFoundError: without one of AccuRay's.
    """
    found: dict[str, Path] = {}
    for path in sorted(folder.glob("reference-*.npy"), key=lambda path: path.stat().st_mtime):
        found[path.stem.removeprefix("reference-").rsplit("-", 2)[0]] = path
    if "accuray" not in found:
        raise FileNotFoundError(
            f"{folder} holds no reference of AccuRay: run `python -m benchmarks --only SCENE` first"
        )
    return {"accuray": found.pop("accuray"), **found}


def block_luminance(image: NDArray[Any]) -> NDArray[np.float64]:
    """Mean luminance of ``BLOCKS`` x ``BLOCKS`` blocks; rows and columns that are left over are not counted."""
    height, width = (side // BLOCKS for side in image.shape[:2])
    luminance = image[: BLOCKS * height, : BLOCKS * width].astype(np.float64) @ measures.LUMINANCE
    means: NDArray[np.float64] = luminance.reshape(BLOCKS, height, BLOCKS, width).mean(axis=(1, 3))
    return means


def compared(images: dict[str, NDArray[Any]]) -> list[dict[str, Any]]:
    """A row for each image: its mean, and the relative differences of its blocks to those of the first image."""
    ours = block_luminance(next(iter(images.values())))
    rows = []
    for name, image in images.items():
        theirs = block_luminance(image)
        relative = theirs / ours - 1.0
        row, column = np.unravel_index(np.abs(relative).argmax(), relative.shape)
        rows.append(
            {
                "renderer": name,
                "mean_rgb": image.mean(axis=(0, 1), dtype=np.float64).tolist(),
                "whole": float(theirs.mean() / ours.mean() - 1.0),
                "typical": float(np.sqrt(np.mean(relative**2))),
                "worst": float(relative[row, column]),
                "at": [int(column), int(row)],
            }
        )
    return rows


def side_by_side(images: dict[str, NDArray[Any]]) -> bytes:
    """A PNG file; one exposure for all."""
    first = next(iter(images.values()))
    scale = WHITE / float(measures.LUMINANCE @ first.mean(axis=(0, 1), dtype=np.float64))
    gap = np.full((first.shape[0], GAP, 3), 255, dtype=np.uint8)
    parts = [part for image in images.values() for part in (gap, srgb8(image * scale))][1:]
    return encode_codes(np.ascontiguousarray(np.concatenate(parts, axis=1)))


def main() -> int:
    """Compares what is in each of the folders."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.agreement", description=main.__doc__)
    parser.add_argument("folders", type=Path, nargs="+", metavar="FOLDER")
    for folder in parser.parse_args().folders:
        images = {name: np.load(path) for name, path in newest_references(folder).items()}
        (folder / "pictures.png").write_bytes(side_by_side(images))
        print(f"\n{folder / 'pictures.png'}\n\n{report.table(compared(images), COLUMNS)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
