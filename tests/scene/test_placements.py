"""Transforms and ids of instances from arrays, .npy and CSV files: what is read, and what is refused, by row."""

from __future__ import annotations

import pickle
import struct
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from instance_arrays import Rows, scene_with, similarities
from numpy.typing import NDArray

from accuray import Scene, SceneError
from accuray.formats.arrays import read_npy
from accuray.scene import memory

ROWS = similarities(7, 1)


def scene(folder: Path | None = None, **shape: Any) -> Scene:
    description = scene_with({"field": {"type": "instance", "of": ["ball", "box"], **shape}})
    return Scene.from_dict(description, folder=folder)


def read(folder: Path | None = None, **shape: Any) -> Rows:
    rows: Rows = scene(folder, **shape).shapes["field"]["instances"].rows()
    return rows


def saved(folder: Path, array: NDArray[Any], name: str = "field.npy") -> str:
    np.save(folder / name, array)
    return name


def csv(folder: Path, text: str, name: str = "field.csv") -> str:
    (folder / name).write_text(text)
    return name


FORMS = {
    "N x 3 x 4": ROWS,
    "N x 12": ROWS.reshape(-1, 12),
    "double": ROWS.astype(np.float64),
    "big-endian": ROWS.astype(">f4"),
    "by columns": np.asfortranarray(ROWS),
    "every other row": np.repeat(ROWS, 2, axis=0)[::2],
}


@pytest.mark.parametrize("form", FORMS)
def test_forms_of_arrays(form: str, tmp_path: Path) -> None:
    for given in (FORMS[form], saved(tmp_path, FORMS[form])):
        rows = read(tmp_path, instances=given)
        assert rows.dtype == np.float32
        assert not rows.flags.writeable
        assert np.array_equal(rows, ROWS.reshape(-1, 12))


def test_csv_with_names_comments_and_ids(tmp_path: Path) -> None:
    ids = [0, 1, 1, 0, 1, 0, 0]
    lines = [", ".join([*(repr(float(x)) for x in row.ravel()), str(i)]) for row, i in zip(ROWS, ids, strict=True)]
    text = "# a field\n\nxx,xy,xz,x,yx,yy,yz,y,zx,zy,zz,z,id\n" + "\n".join([*lines[:3], "", *lines[3:]]) + "  # end\n"
    shape = scene(tmp_path, instances=csv(tmp_path, text)).shapes["field"]
    assert np.array_equal(shape["instances"].rows(), ROWS.reshape(-1, 12))
    assert shape["ids"].tolist() == ids
    assert shape["ids"].dtype == np.uint32


def test_translations_are_in_the_unit_of_the_file() -> None:
    description = scene_with({"field": {"type": "instance", "of": "ball", "instances": ROWS}}, length_unit="cm")
    rows = Scene.from_dict(description).shapes["field"]["instances"].rows().reshape(-1, 3, 4)
    assert np.array_equal(rows[:, :, :3], ROWS[:, :, :3])
    assert np.allclose(rows[:, :, 3], ROWS[:, :, 3] / 100, rtol=1e-7)


def test_a_written_array_does_not_change_the_scene_and_a_frozen_one_is_not_copied() -> None:
    mine = ROWS.copy()
    rows = read(instances=mine)
    mine[:] = 0
    assert np.array_equal(rows, ROWS.reshape(-1, 12))
    frozen = ROWS.copy()
    frozen.flags.writeable = False
    assert np.shares_memory(read(instances=frozen), frozen)


# --- Identity ---------------------------------------------------------------------------------------------------------


def test_identity_is_that_of_the_content(tmp_path: Path) -> None:
    ids = np.arange(len(ROWS)) % 2
    text = "\n".join(",".join(repr(float(x)) for x in [*row.ravel(), i]) for row, i in zip(ROWS, ids, strict=True))
    same = {
        scene(tmp_path, instances=ROWS, ids=ids).identity,
        scene(tmp_path, instances=saved(tmp_path, ROWS), ids=saved(tmp_path, ids, "ids.npy")).identity,
        scene(tmp_path, instances=saved(tmp_path, ROWS.astype(">f8"), "again.npy"), ids=ids.astype(float)).identity,
        scene(tmp_path, instances=csv(tmp_path, text)).identity,
    }
    assert len(same) == 1
    moved = ROWS.copy()
    moved[6, 2, 3] = np.nextafter(moved[6, 2, 3], np.float32(9))
    others = {
        scene(tmp_path, instances=moved, ids=ids).identity,
        scene(tmp_path, instances=ROWS[::-1], ids=ids).identity,
        scene(tmp_path, instances=ROWS, ids=1 - ids).identity,
        scene(tmp_path, instances=ROWS).identity,
    }
    assert len(others | same) == 5


def test_what_was_forgotten_is_read_again_if_it_is_the_same(tmp_path: Path) -> None:
    transforms = scene(tmp_path, instances=saved(tmp_path, ROWS)).shapes["field"]["instances"]
    transforms.forget()
    assert np.array_equal(transforms.rows(), ROWS.reshape(-1, 12))
    transforms.forget()
    saved(tmp_path, ROWS[::-1])
    with pytest.raises(ValueError, match="has changed since the scene was read"):
        transforms.rows()
    of_python = scene(instances=ROWS).shapes["field"]["instances"]
    of_python.forget()
    assert of_python.count == len(of_python.rows()) == len(ROWS)


# --- Errors by row ----------------------------------------------------------------------------------------------------


def with_row(row: int, matrix: Any) -> Rows:
    rows = np.tile(np.eye(3, 4, dtype=np.float32), (65_537, 1, 1))
    rows[row] = matrix
    return rows


BAD_ROWS = {
    "nan": (np.full((3, 4), np.nan), "is not finite"),
    "infinite": ([[1, 0, 0, np.inf], [0, 1, 0, 0], [0, 0, 1, 0]], "is not finite"),
    "zero": (np.zeros((3, 4)), "flattens"),
    "flat": ([[1, 0, 0, 0], [0, 0, 0, 0], [0, 0, 1, 0]], "flattens"),
    "sheared": ([[1, 0.1, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]], "shears or stretches"),
    "stretched": ([[1, 0, 0, 0], [0, 1.001, 0, 0], [0, 0, 1, 0]], "shears or stretches"),
    "far": ([[1, 0, 0, 1e16], [0, 1, 0, 0], [0, 0, 1, 0]], "too far"),
    "tiny": (1e-16 * np.eye(3, 4), "too far"),
    "far for its size": ([[1e-9, 0, 0, 1e8], [0, 1e-9, 0, 0], [0, 0, 1e-9, 0]], "too far"),
}


@pytest.mark.parametrize("case", BAD_ROWS)
@pytest.mark.parametrize("row", [0, 65_536])
def test_bad_rows_are_named(case: str, row: int) -> None:
    matrix, problem = BAD_ROWS[case]
    with pytest.raises(SceneError, match=rf"shapes\.field\.instances\[{row}\]: .*{problem}"):
        scene(instances=with_row(row, matrix))


def test_rounded_rotations_are_no_shears() -> None:
    rows = similarities(2000, 5)
    assert np.array_equal(read(instances=rows.astype(np.float16).astype(np.float32) * 0 + rows), rows.reshape(-1, 12))


BAD_VALUES: dict[str, tuple[dict[str, Any], str]] = {
    "a list": ({"instances": [[1.0] * 12]}, "instances: .*is not a file name.*numpy array"),
    "no array": ({"instances": 3}, "instances: 3 is not a file name"),
    "square matrices": ({"instances": np.zeros((5, 4, 4))}, r"has the shape \(5, 4, 4\).*\(N, 3, 4\)"),
    "one row": ({"instances": np.zeros(12)}, r"has the shape \(12,\)"),
    "texts": ({"instances": np.array([["a"] * 12])}, "is an array of <U1"),
    "objects": ({"instances": np.array([[None] * 12])}, "is an array of object"),
    "complex": ({"instances": np.zeros((2, 12), dtype=complex)}, "is an array of complex128"),
    "ids alone": ({"ids": np.zeros(3)}, "ids: are of no use without `instances`"),
    "too few ids": ({"instances": ROWS, "ids": np.zeros(3)}, "ids: has 3 rows: allowed 7"),
    "an id too large": ({"instances": ROWS, "ids": np.array([0, 1, 0, 2, 0, 0, 0])}, r"ids\[3\]: 2 is not.* 0 to 1"),
    "a negative id": ({"instances": ROWS, "ids": np.array([0, -1, 0, 0, 0, 0, 0])}, r"ids\[1\]: -1 is not an id"),
    "half an id": ({"instances": ROWS, "ids": np.array([0, 0, 0.5, 0, 0, 0, 0])}, r"ids\[2\]: 0\.5 is not an id"),
    "ids in rows": ({"instances": ROWS, "ids": np.zeros((7, 2))}, r"ids: .*shape \(7, 2\)"),
    "a NaN for an id": ({"instances": ROWS, "ids": np.full(7, np.nan)}, r"ids\[0\]: nan is not an id"),
}


@pytest.mark.parametrize("case", BAD_VALUES)
def test_bad_values(case: str) -> None:
    shape, message = BAD_VALUES[case]
    with pytest.raises(SceneError, match=message):
        scene(**shape)


def test_ids_are_given_once(tmp_path: Path) -> None:
    text = "\n".join(",".join(map(str, [1, 0, 0, i, 0, 1, 0, 0, 0, 0, 1, 0, 0])) for i in range(3))
    with pytest.raises(SceneError, match=r"ids: are given twice"):
        scene(tmp_path, instances=csv(tmp_path, text), ids=np.zeros(3))


# --- Files that lie ---------------------------------------------------------------------------------------------------


def npy(header: str, data: bytes = b"", version: tuple[int, int] = (1, 0)) -> bytes:
    """A .npy file with this header, as it stands."""
    length = struct.pack("<H" if version == (1, 0) else "<I", len(header) + 1)
    return b"\x93NUMPY" + bytes(version) + length + header.encode("latin-1") + b"\n" + data


def header(descr: str = "'<f4'", shape: str = "(4294967296, 3, 4)", order: str = "False") -> str:
    return f"{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}"


LIES = {
    "2^32 instances": npy(header(), bytes(100)),
    "2^62 instances": npy(header(shape="(4611686018427387904, 3, 4)"), bytes(100)),
    "as much as wraps around": npy(header(shape="(18446744073709551616, 3, 4)")),
    "more numbers than a size": npy(header(shape="(" + "9" * 4000 + ", 3, 4)")),
    "less than it has": npy(header(shape="(1, 3, 4)"), bytes(100)),
    "a negative shape": npy(header(shape="(-1, 3, 4)"), bytes(48)),
    "a pickle": npy(header("'|O'", "(4,)"), pickle.dumps([1, 2, 3, 4])),
    "a record": npy(header("[('a', '<f4'), ('b', '|O')]", "(2,)"), bytes(24)),
    "an array in a record": npy(header("('<f4', (3, 4))", "(2,)"), bytes(96)),
    "texts": npy(header("'<U4'", "(1, 12)"), bytes(192)),
    "no type": npy(header("'<q9'", "(1, 12)"), bytes(48)),
    "no shape": npy("{'descr': '<f4', 'fortran_order': False}", bytes(48)),
    "a shape of texts": npy(header(shape="('a', 'b')"), bytes(48)),
    "no dictionary": npy("__import__('os').system('true')", bytes(48)),
    "deep brackets": npy("(" * 9000, bytes(48)),
    "a long header": npy("{" + " " * 60_000 + "}", bytes(48)),
    "a header without an end": npy(header())[:40],
    "another version": npy(header(shape="(1, 3, 4)"), bytes(48), (3, 0)),
    "no magic": b"NUMPY" + bytes(200),
    "nothing": b"",
}


@pytest.mark.parametrize("case", LIES)
def test_files_that_lie(case: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "field.npy").write_bytes(LIES[case])
    monkeypatch.setattr(pickle, "loads", None)
    with pytest.raises(SceneError, match=r"instances: .*field\.npy"):
        scene(tmp_path, instances="field.npy")


def test_every_truncation_and_many_damages_of_a_file(tmp_path: Path) -> None:
    saved(tmp_path, ROWS)
    whole = (tmp_path / "field.npy").read_bytes()
    rng = np.random.default_rng(3)
    damaged = [whole[:end] for end in range(len(whole))]
    damaged += [whole[:place] + rng.bytes(1) + whole[place + 1 :] for place in range(128)]
    for content in damaged:
        (tmp_path / "field.npy").write_bytes(content)
        with suppress(ValueError):
            read_npy(tmp_path / "field.npy")


BAD_CSV = {
    "a text": ("1,0,0,0,0,1,0,0,0,0,1,0\n1,0,0,zero,0,1,0,0,0,0,1,0\n", "zero.*row 1"),
    "short row": ("1,0,0,0,0,1,0,0,0,0,1,0\n1,0,0\n", "row 2"),
    "eleven columns": ("1,0,0,0,0,1,0,0,0,0,1\n", r"has the shape \(1, 11\)"),
    "names alone": ("a,b,c\n", "has no rows"),
    "nothing": ("", "has no rows"),
    "no text": ("\0\1\2\n", "has no rows"),
    "spelled nan": ("1,0,0,nan,0,1,0,0,0,0,1,0\n", r"instances\[0\]: .*is not finite"),
}


@pytest.mark.parametrize("case", BAD_CSV)
def test_bad_csv(case: str, tmp_path: Path) -> None:
    text, message = BAD_CSV[case]
    with pytest.raises(SceneError, match=message):
        scene(tmp_path, instances=csv(tmp_path, text))


def test_files_stay_inside_the_folder_of_the_scene(tmp_path: Path) -> None:
    inside = tmp_path / "scene"
    inside.mkdir()
    saved(tmp_path, ROWS)
    with pytest.raises(SceneError, match="leads outside"):
        scene(inside, instances="../field.npy")
    csv(inside, "", "field.txt")
    with pytest.raises(SceneError, match=r"allowed \.npy, \.csv"):
        scene(inside, instances="field.txt")


def test_a_file_larger_than_the_memory_is_refused_unread(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    name = saved(tmp_path, ROWS)
    monkeypatch.setattr(memory, "available_bytes", lambda: 500)
    with pytest.raises(SceneError, match=r"its 336 bytes would take 672 B: allowed are the 500 B that are free"):
        scene(tmp_path, instances=name)


# --- The memory of this machine ---------------------------------------------------------------------------------------


def test_available_memory_is_the_least_of_system_and_control_groups(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(memory, "MEMINFO", tmp_path / "meminfo")
    monkeypatch.setattr(memory, "CGROUPS", tmp_path / "cgroup")
    monkeypatch.setattr(memory, "CGROUP_ROOT", tmp_path / "groups")
    assert memory.available_bytes() >= 1 << 60
    (tmp_path / "meminfo").write_text("MemTotal:  99 kB\nMemAvailable:    64 kB\n")
    assert memory.available_bytes() == 64 << 10
    (tmp_path / "cgroup").write_text("4:cpu,memory:/a/b\n0::/c\n")
    for group, names in {
        "memory": ("memory.limit_in_bytes", "memory.usage_in_bytes"),
        "memory/a/b": ("memory.limit_in_bytes", "memory.usage_in_bytes"),
        "c": ("memory.max", "memory.current"),
    }.items():
        folder = tmp_path / "groups" / group
        folder.mkdir(parents=True, exist_ok=True)
        for name, value in zip(names, ("9223372036854771712", "20000"), strict=True):
            (folder / name).write_text(value + "\n")
    assert memory.available_bytes() == 64 << 10
    (tmp_path / "groups/c/memory.max").write_text("max\n")
    assert memory.available_bytes() == 64 << 10
    (tmp_path / "groups/c/memory.max").write_text("60000\n")
    assert memory.available_bytes() == 40000
    (tmp_path / "groups/memory/memory.limit_in_bytes").write_text("30000\n")
    assert memory.available_bytes() == 10000
    (tmp_path / "groups/memory/memory.stat").write_text("cache 9\ntotal_inactive_file 5000\n")
    assert memory.available_bytes() == 15000


SIZES = {0: "0 B", 1023: "1023 B", 1024: "1.0 KiB", 435 << 40: "435.0 TiB", 1 << 90: "1073741824.0 EiB"}


@pytest.mark.parametrize("size", SIZES)
def test_readable_sizes(size: int) -> None:
    assert memory.readable(size) == SIZES[size]
