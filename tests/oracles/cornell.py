"""The measured Cornell box for the radiosity oracle, and its stored solution.

The box is built from the committed measurement files alone (`accuray/data`), in millimetres: the lamp's hole is cut out
of the ceiling, the floor leaves out what the blocks stand on, the red wall (which is not planar) is split along the
diagonal from its first to its third listed corner, and the open front is a black surface called `opening`.

Run in the folder `tests`, `python -m oracles.cornell` solves the box on all meshes and rewrites the stored solution
(`cornell_radiosity.json`); that takes a few minutes and 1 GB.
"""

from __future__ import annotations

import json
import re
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from .enclosure import Enclosure, Piece, quadrilaterals, without
from .form_factors import Array, Prism
from .radiosity import Solution, extrapolate, macro_elements, mesh, solve

DATA = Path(__file__).resolve().parents[2] / "accuray" / "data"
REFERENCE = Path(__file__).with_name("cornell_radiosity.json")
WAVELENGTHS = [450.0, 550.0, 650.0]
REFINEMENTS = [1, 2, 3, 4]
BLOCKS = ["short_block", "tall_block"]


def cornell_box() -> Enclosure:
    """The box of `cornell_box_geometry.json`; the short block is number 0, the tall one number 1."""
    data = json.loads((DATA / "cornell_box_geometry.json").read_text(encoding="utf-8"))["surfaces"]
    quads = {name: np.array(entry["quads"], dtype=float) for name, entry in data.items()}
    material = {name: str(entry["material"]) for name, entry in data.items()}
    blocks = [_prism(quads[name]) for name in BLOCKS]
    holes = {
        "floor": [np.insert(block.base, 1, 0.0, axis=1) for block in blocks],
        "ceiling": [np.array(data["ceiling"]["hole_for_light"], dtype=float)],
    }

    def pieces() -> Iterator[Piece]:
        for name in ("floor", "ceiling", "back_wall", "right_wall"):
            polygons = [quads[name][0]]
            for hole in holes.get(name, []):
                polygons = [part for polygon in polygons for part in without(polygon, hole)]
            yield Piece(name, material[name], np.concatenate([quadrilaterals(polygon) for polygon in polygons]))
        for corners in ([0, 1, 2], [0, 2, 3]):
            yield Piece("left_wall", material["left_wall"], quadrilaterals(quads["left_wall"][0][corners]))
        yield Piece("light", "light", quads["light"])
        for number, name in enumerate(BLOCKS):
            for quad in quads[name]:
                yield Piece(name, material[name], quad[None], number)
        floor, ceiling = quads["floor"][0], quads["ceiling"][0]
        yield Piece("opening", "opening", np.array([[floor[1], floor[0], ceiling[0], ceiling[3]]]))

    return Enclosure(list(pieces()), blocks)


def _prism(faces: Array) -> Prism:
    """The block whose first listed face is its top and whose sides reach down to the floor."""
    return Prism(faces[0][:, [0, 2]], float(faces[..., 1].min()), float(faces[..., 1].max()))


def cornell_spectra(wavelengths: list[float]) -> tuple[dict[str, Array], Array]:
    """Reflectances by material and the lamp's relative radiance at wavelengths in nanometres, linearly interpolated."""
    paint = np.genfromtxt(DATA / "cornell_box_reflectance.csv", delimiter=",", skip_header=2)
    lamp = np.genfromtxt(DATA / "cornell_box_light.csv", delimiter=",", skip_header=2)
    data = json.loads((DATA / "cornell_box_geometry.json").read_text(encoding="utf-8"))
    columns = enumerate(("white", "green", "red"), 1)
    reflectance = {name: np.interp(wavelengths, paint[:, 0], paint[:, k]) for k, name in columns}
    reflectance["light"] = np.full(len(wavelengths), float(data["surfaces"]["light"]["reflectance_constant"]))
    reflectance["opening"] = np.zeros(len(wavelengths))
    return reflectance, np.interp(wavelengths, lamp[:, 0], lamp[:, 1])


def solve_cornell(refinement: int) -> Solution:
    """Solve the box at the three wavelengths, each macro element divided into refinement x refinement elements.

    The floor has the finest elements: it carries the blocks' shadows, and their dark faces see little else.
    """
    scene = cornell_box()
    macros = macro_elements(scene, size=100.0, finer={"floor": 50.0})
    return solve(scene, mesh(scene, macros, refinement), cornell_spectra(WAVELENGTHS)[0], "light")


def reference() -> dict[str, Any]:
    """The stored solution: `limit` and `levels` hold area averages per unit of lamp radiance, by surface or face."""
    document: dict[str, Any] = json.loads(REFERENCE.read_text(encoding="utf-8"))
    return document


def main() -> None:
    """Solve the box on all meshes, print how long each took, and rewrite the stored solution."""
    solutions = []
    for refinement in REFINEMENTS:
        began = time.perf_counter()
        solutions.append(solve_cornell(refinement))
        print(f"{refinement}: {solutions[-1].elements} elements, {time.perf_counter() - began:.1f} s")
    coarse, fine = solutions[-2:]
    ratio = REFINEMENTS[-1] / REFINEMENTS[-2]
    limits = {name: extrapolate(coarse.averages[name], fine.averages[name], ratio) for name in fine.averages}
    reflectance, lamp = cornell_spectra(WAVELENGTHS)
    document = {
        "about": "Area averages of outgoing radiance in the diffuse Cornell box per unit of lamp radiance, computed by "
        "tests/oracles/cornell.py. The floor is the part that no block covers; name/k is a block's k-th listed face; "
        "limit is Richardson's extrapolation of the last two levels.",
        "wavelengths_nm": WAVELENGTHS,
        "lamp_radiance": _rounded(lamp),
        "reflectance": {name: _rounded(values) for name, values in reflectance.items()},
        "limit": {name: _rounded(values) for name, values in limits.items()},
        "levels": [_level(*entry) for entry in zip(REFINEMENTS, solutions, strict=True)],
    }
    text = re.sub(r"\s+(?=[\d\]])", " ", json.dumps(document, indent=1))
    REFERENCE.write_text(text + "\n", encoding="utf-8")


def _level(refinement: int, solution: Solution) -> dict[str, Any]:
    return {
        "refinement": refinement,
        "elements": solution.elements,
        "closure": float(f"{solution.closure:.1e}"),
        "reciprocity": float(f"{solution.reciprocity:.3g}"),
        "averages": {name: _rounded(values) for name, values in solution.averages.items()},
    }


def _rounded(values: Array) -> list[float]:
    return [float(f"{value:.8g}") for value in values]


if __name__ == "__main__":
    main()
