"""What `import accuray` promises: names, arguments, and that nothing depends on the order of imports."""

from __future__ import annotations

import copy
import gc
import pickle
import subprocess
import sys

import numpy as np
import pytest

import accuray
from accuray.devices import cpu


def small_scene(**film: object) -> accuray.Scene:
    """A grey sphere under a constant sky, 16 x 8 pixels."""
    return accuray.Scene.from_dict(
        {
            "film": {"width": 16, "height": 8, **film},
            "materials": {"grey": {"type": "diffuse", "reflectance": 0.5}},
            "shapes": {"ball": {"type": "sphere", "material": "grey"}},
            "lights": {"sky": {"type": "constant"}},
        }
    )


def test_every_public_name_exists() -> None:
    for name in accuray.__all__:
        assert getattr(accuray, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'rendr'"):
        _ = accuray.rendr  # type: ignore[attr-defined]


@pytest.mark.parametrize("first", ["accuray.radiance", "accuray.render", "accuray.render.session", "accuray.verify"])
def test_render_can_be_called_whatever_was_imported_first(first: str) -> None:
    code = f"import accuray; {'import ' + first if first.count('.') > 1 else first}; assert callable(accuray.render)"
    if first == "accuray.verify":
        code = "import accuray.verify; import accuray; assert callable(accuray.render)"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_an_image_is_an_array() -> None:
    image = accuray.render(small_scene(), spp=4)
    array = np.asarray(image)
    assert array.shape == (8, 16, 3)
    assert array.dtype == np.float32
    assert image.metadata["scene_hash"] == small_scene().identity
    assert {"rgb", "alpha", "error", "samples"} <= set(image.layers)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"spp": 0}, "samples 0:0"),
        ({"spp": 2**32}, "not a range"),
        ({"samples": (5, 5)}, "samples 5:5"),
        ({"seed": -1}, "seed is -1"),
        ({"threads": 0}, "threads is 0"),
        ({"on_interrupt": "ignore"}, "'ignore'"),
    ],
)
def test_wrong_arguments_are_named(arguments: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        accuray.render(small_scene(), **arguments)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("origins", "directions", "options", "message"),
    [
        ([[0, 0, 3]], [[0, 0, 0]], {}, "direction 0 is zero"),
        ([[0, 0]], [[0, 0, 1]], {}, "shape"),
        ([[0, 0, np.nan]], [[0, 0, 1]], {}, "not finite"),
        ([[0, 0, 3], [0, 0, 3]], [[0, 0, 1]], {}, "2 origins but 1 directions"),
        ([[0, 0, 3]], [[0, 0, -1]], {"space": "lab"}, "'lab'"),
        ([[0, 0, 3]], [[0, 0, -1]], {"wavelengths": [1200.0]}, "1200"),
        ([[0, 0, 3]], [[0, 0, -1]], {"wavelengths": []}, "empty"),
    ],
)
def test_wrong_rays_are_named(origins: object, directions: object, options: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        accuray.radiance(small_scene(), origins, directions, 4, **options)  # type: ignore[arg-type]


def test_radiance_of_a_convex_body_under_the_sky() -> None:
    measured = accuray.radiance(
        small_scene(), [[0.0, 0.0, 3.0]], [[0.0, 0.0, -2.0]], 4096, wavelengths=[450, 550, 650, 700, 800]
    )
    assert measured.mean.shape == (1, 5)
    assert np.all(np.abs(measured.mean - 0.5) < 6 * measured.error + 1e-4)


def test_a_scene_is_lowered_once_and_forgotten_with_it() -> None:
    scene = small_scene()
    first = accuray.render(scene, spp=4)
    assert cpu.load(scene) is cpu.load(scene)
    assert accuray.render(scene, spp=4).pixels_equal(first)
    key = id(scene)
    assert key in cpu._loaded
    del scene
    gc.collect()
    assert key not in cpu._loaded


def test_a_rendered_scene_can_be_copied_and_pickled() -> None:
    scene = small_scene()
    image = accuray.render(scene, spp=4)
    for other in (copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))):
        assert other.identity == scene.identity
        assert accuray.render(other, spp=4).pixels_equal(image)


def test_degenerate_shapes_are_scene_errors() -> None:
    base = {"materials": {"m": {"type": "diffuse"}}}
    broken = {
        "shapes.r": {"shapes": {"r": {"type": "rectangle", "edge_v": [2, 0, 0], "material": "m"}}},
        "shapes.d": {"shapes": {"d": {"type": "disk", "normal": [0, 0, 0], "material": "m"}}},
        "camera.up": {"camera": {"type": "perspective", "up": [0, 0, 1]}},
    }
    for key, part in broken.items():
        scene = accuray.Scene.from_dict({**base, **part})
        with pytest.raises(accuray.SceneError) as caught:
            accuray.render(scene, spp=1)
        assert caught.value.key == key
