"""glTF files by AccuRay and by Cycles from Blender's import of the same file, block by block in linear Rec.709.

Where both follow glTF (lights, emission, cameras, pictures, matte surfaces, metal, plastic, clear coats, clear glass)
blocks may differ by some per cent, for noise and for spectra in place of three colours. Where Blender's Principled BSDF
is another model, the case says which way and how far:

- saturated colours under gloss, for the light between gloss and base is computed in colours when a file is read and in
  spectra when it is rendered;
- partly metal surfaces: AccuRay's matte share is darkened by the light that its gloss sends back inside, for one base
  colour cannot be right for the metal as well;
- metal under a coat: the same, between coat and metal, which Blender leaves out;
- fuzz: glTF's is the lobe of Estevez and Kulla (2017), as AccuRay's; Blender has Zeltner's (2022);
- coloured bodies: glTF's attenuationColor is what is left after the distance, exponentially; Blender's import makes a
  density 1 / distance times 1 - colour of it.
"""

from __future__ import annotations

import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from gltf_cases import CASES, HEIGHT, WIDTH
from numpy.typing import NDArray

from benchmarks import peers

pytest.importorskip("accuray._core", reason="the compiled module is not built")
import accuray

SEED = int(os.environ.get("ACCURAY_TEST_SEED", "0"))
SCRIPT = Path(__file__).with_name("cycles_gltf.py")
SPP = 512
BLOCK = 8
DARK = 0.05
"""Blocks darker than this share of the brightest are compared with that share: light is left there, and noise."""

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(bool(peers.missing("cycles")), reason=f"Cycles: {peers.missing('cycles')}"),
]


@dataclass(frozen=True)
class Expected:
    """Largest relative difference of a block in any colour.

    Columns of blocks in which the models differ are left out; there the mean of all colours lies within two limits.
    """

    largest: float
    apart: tuple[int, ...] = ()
    between: tuple[float, float] = (0.0, 0.0)


EXPECTED = {
    "lights": Expected(0.03),
    "emission": Expected(0.025),
    "textures": Expected(0.05),
    "metals": Expected(0.05),
    "plastics": Expected(0.15, (6,), (-0.25, -0.1)),
    "coat": Expected(0.11),
    "fuzz": Expected(0.05, (4,), (0.15, 0.35)),
    "coated_metal": Expected(0.12, (6,), (-0.35, -0.2)),
    "glass": Expected(0.12, (6,), (-0.35, -0.1)),
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The files, and Cycles' pictures of them."""
    where: Path = tmp_path_factory.mktemp("gltf")
    for name, build in CASES.items():
        build().save(where / f"{name}.glb")
    line = [str(peers.python_of("cycles")), str(SCRIPT), str(where), str(WIDTH), str(HEIGHT), str(SPP)]
    line += [str(peers.DRIVERS), *CASES]
    subprocess.run(line, check=True, env=peers.environment("cycles"), timeout=1800, stdout=subprocess.DEVNULL)
    return where


def blocks(pixels: NDArray[np.float32]) -> NDArray[np.float64]:
    """Means of blocks (H / 8, W / 8, 3)."""
    means: NDArray[np.float64] = pixels.reshape(HEIGHT // BLOCK, BLOCK, WIDTH // BLOCK, BLOCK, 3).mean(
        axis=(1, 3), dtype=np.float64
    )
    return means


@pytest.mark.parametrize("name", CASES)
def test_a_gltf_file_looks_as_in_cycles(name: str, folder: Path) -> None:
    film = {"film.width": WIDTH, "film.height": HEIGHT, "film.filter.type": "box"}
    scene = accuray.load(folder / f"{name}.glb", overrides=film)
    ours = blocks(np.asarray(accuray.render(scene, spp=SPP, seed=SEED)))
    theirs = blocks(np.load(folder / f"{name}.npy"))
    relative = (ours - theirs) / np.maximum(theirs, DARK * theirs.max())
    expected = EXPECTED[name]
    same = np.delete(relative, expected.apart, axis=1)
    print(f"{name}: largest {np.abs(same).max():.3f}, typical {np.sqrt(np.mean(same**2)):.4f}")
    assert (theirs > DARK * theirs.max()).mean() > 0.1, "there is something to see"
    assert np.abs(same).max() <= expected.largest, (100 * same.mean(axis=2)).round(1)
    for column in expected.apart:
        difference = relative[2:4, column].mean()
        print(f"{name}: models differ by {difference:+.3f}")
        assert expected.between[0] <= difference <= expected.between[1]
