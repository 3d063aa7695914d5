"""Time to equal error with many lamps: a hall lit by 10, 10 000 and 100 000 equal lamps of the same flux in all.

``python -m benchmarks.lights`` prints JSON and a table. The relative variance comes from the film's own standard
errors, so no reference is needed; AccuRay alone is measured, against itself with ten lamps.
"""

import json
import sys
import time
from collections.abc import Sequence
from statistics import median
from typing import Any

import numpy as np
from numpy.typing import NDArray

import accuray
from accuray.film.estimates import pixel_estimates
from benchmarks import measures, report, settings

COUNTS = (10, 10_000, 100_000)
LIMITED = 10_000
RATIO_LIMIT = 3.0
"""The time to an error with ``LIMITED`` lamps over that with ten is held to this; the largest count is reported."""

SIZE = 20.0
HEIGHT = 10.0
LAMP_HEIGHTS = (1.0, 4.0)
LAMP_AREA = 0.5
"""Of all lamps together, m^2."""

BOXES = 120
WIDTH, ROWS = 160, 120

COLUMNS = {
    "scene": "hall",
    "lamps": "lamps|d",
    "cpu_s": "CPU s|.2f",
    "relative_mse": "relMSE|.3g",
    "time_to_error": "CPU s x relMSE|.3g",
    "ratio": "over ten lamps|.2f",
    "set_up_s": "set-up s|.2f",
}

Mesh = tuple[NDArray[np.float32], NDArray[np.uint32]]
QUAD = np.array([[0, 1, 2], [0, 2, 3]])


def lamps(count: int) -> Mesh:
    """Squares that lean by some 20 degrees from facing the floor: a camera above them sees few of them shine."""
    rng = np.random.default_rng(11)
    middle = np.column_stack(
        [
            rng.uniform(-SIZE / 2, SIZE / 2, count),
            rng.uniform(*LAMP_HEIGHTS, count),
            rng.uniform(-SIZE / 2, SIZE / 2, count),
        ]
    )
    normal = _unit(rng.normal(size=(count, 3)) * [1, 0, 1] + [0, -4, 0])
    x = _unit(np.cross(normal, [0.0, 0.0, 1.0]))
    y = np.cross(normal, x)
    half = 0.5 * np.sqrt(LAMP_AREA / count)
    corners = [middle + half * (a * x + b * y) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    faces = 4 * np.arange(count)[:, None, None] + QUAD
    return np.stack(corners, axis=1).reshape(-1, 3).astype(np.float32), faces.reshape(-1, 3).astype(np.uint32)


def _unit(v: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(v / np.linalg.norm(v, axis=1, keepdims=True))


def boxes(count: int) -> dict[str, dict[str, Any]]:
    """What stands on the floor and hides lamps from it."""
    rng = np.random.default_rng(7)
    found = {}
    for i in range(count):
        (x, z), (a, b) = rng.uniform(-SIZE / 2, SIZE / 2, 2), rng.uniform(0.2, 0.8, 2)
        height = rng.uniform(0.5, 3.0)
        place = {"center": [float(x), float(height / 2), float(z)], "size": [float(a), float(height), float(b)]}
        found[f"box-{i}"] = {"type": "cube", "material": "grey", **place}
    return found


def walls() -> dict[str, dict[str, Any]]:
    """Floor, ceiling and four walls, seen from inside."""
    s, h = SIZE / 2, HEIGHT
    rectangles = {
        "floor": ([-s, 0, s], [SIZE, 0, 0], [0, 0, -SIZE]),
        "ceiling": ([-s, h, -s], [SIZE, 0, 0], [0, 0, SIZE]),
        "north": ([-s, 0, -s], [SIZE, 0, 0], [0, h, 0]),
        "south": ([s, 0, s], [-SIZE, 0, 0], [0, h, 0]),
        "west": ([-s, 0, s], [0, 0, -SIZE], [0, h, 0]),
        "east": ([s, 0, -s], [0, 0, SIZE], [0, h, 0]),
    }
    return {
        name: {"type": "rectangle", "material": "grey", "corner": corner, "edge_u": u, "edge_v": v}
        for name, (corner, u, v) in rectangles.items()
    }


def hall(count: int, occluders: bool) -> accuray.Scene:
    """The hall with so many lamps; all light, without a limit of depth."""
    positions, faces = lamps(count)
    shapes = walls() | (boxes(BOXES) if occluders else {})
    shapes["lamps"] = {"type": "mesh", "material": "lamp", "positions": positions, "faces": faces}
    glow = {"illuminant": "D65", "scale": 60.0}
    return accuray.Scene.from_dict(
        {
            "film": {"width": WIDTH, "height": ROWS},
            "camera": {"type": "perspective", "position": [0, 8, 9.5], "look_at": [0, 0, -1], "fov": 60},
            "materials": {
                "grey": {"type": "diffuse", "reflectance": 0.5},
                "lamp": {"type": "diffuse", "reflectance": 0, "emission": glow},
            },
            "shapes": shapes,
        }
    )


def measure(
    repeats: int = settings.REPEATS, spp: int = settings.EFFICIENCY_SPP, counts: Sequence[int] = COUNTS
) -> list[dict[str, Any]]:
    """A row for each hall and number of lamps; ``ratio`` is to the first number of the same hall."""
    rows: list[dict[str, Any]] = []
    for name, occluders in (("empty", False), ("with boxes", True)):
        first: float | None = None
        for count in counts:
            row = {"scene": name, "lamps": count} | _measured(hall(count, occluders), repeats, spp)
            first = first or row["time_to_error"]
            rows.append(row | {"ratio": row["time_to_error"] / first})
    return rows


def _measured(scene: accuray.Scene, repeats: int, spp: int) -> dict[str, Any]:
    started = time.perf_counter()
    accuray.render(scene, spp=4, threads=settings.THREADS)
    set_up = time.perf_counter() - started
    seconds, errors = [], []
    for k in range(repeats):
        started = time.process_time()
        image = accuray.render(scene, spp=spp, threads=settings.THREADS, seed=settings.MEASURED_SEED + k)
        seconds.append(time.process_time() - started)
        errors.append(_relative_variance(image))
    row = {"cpu_s": median(seconds), "relative_mse": median(errors), "set_up_s": set_up, "spp": spp}
    return row | {"time_to_error": row["cpu_s"] * row["relative_mse"]}


def _relative_variance(image: accuray.Image) -> float:
    """As ``measures.relative_mse``, with the squares of the pixels' standard errors for those of the differences."""
    mean, error = pixel_estimates(image.film)
    scale = float(measures.LUMINANCE @ np.array(settings.REFERENCE_MEAN_RGB)) / float(mean[..., 1].mean())
    return float(np.mean((error * scale) ** 2 / ((mean * scale) ** 2 + settings.RELATIVE_MSE_OFFSET)))


def figures(rows: Sequence[dict[str, Any]]) -> list[tuple[str, float, float, bool]]:
    """What is held to the limit, as ``report.limits`` takes it."""
    return [
        (f"time to error, {row['lamps']} lamps over ten, hall {row['scene']}", row["ratio"], RATIO_LIMIT, True)
        for row in rows
        if row["lamps"] == LIMITED
    ]


def main() -> int:
    """Measure and print; the first line is JSON."""
    found = measure()
    print(json.dumps(found))
    print(report.table(found, COLUMNS))
    print("\n" + report.table(report.limits(figures(found)), report.LIMIT_COLUMNS))
    return 0


if __name__ == "__main__":
    sys.exit(main())
