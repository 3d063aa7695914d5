"""Lines of key paths in TOML and JSON texts."""

from __future__ import annotations

import json
import tomllib
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scene_support import STEADY

from accuray.scene.locate import locate

TOML = """\
# comment [not.a.table]
accuray = 1
title = "a # b"  # [x]
film.width = 3
[camera]
type = "perspective" # = [
position = [
  1, # one
  2,
  [3,
   4],
]
"quoted key" = 'lit # eral'
'literal.key' = 5
multi = \"\"\"
[fake]
width = 9
\"\"\"
raw = '''
[fake2] '''
[materials."a b"]
reflectance = { file = "x.csv", deep = { a = 1, b = [1, 2] } }
[materials.c.d]
e.f = 2026-01-01T00:00:00Z
[[list]]
a = 1
[[list]]
b = 2
[list.sub]
c = 3
"""


@pytest.mark.parametrize(
    ("path", "line"),
    [
        (("accuray",), 2),
        (("film", "width"), 4),
        (("film",), 4),
        (("camera",), 5),
        (("camera", "type"), 6),
        (("camera", "position"), 7),
        (("camera", "position", 0), 8),
        (("camera", "position", 1), 9),
        (("camera", "position", 2, 1), 11),
        (("camera", "quoted key"), 13),
        (("camera", "literal.key"), 14),
        (("camera", "multi"), 15),
        (("camera", "raw"), 19),
        (("materials", "a b"), 21),
        (("materials", "a b", "reflectance", "deep", "b", 1), 22),
        (("materials", "c", "d", "e", "f"), 24),
        (("list", 0, "a"), 26),
        (("list", 1, "b"), 28),
        (("list", 1, "sub", "c"), 30),
        (("camera", "missing"), 5),
        (("nowhere",), None),
        ((), None),
    ],
)
def test_toml(path: tuple[str | int, ...], line: int | None) -> None:
    tomllib.loads(TOML)
    assert locate(TOML, "toml", path) == line


def test_toml_with_windows_line_ends() -> None:
    assert locate(TOML.replace("\n", "\r\n"), "toml", ("list", 1, "b")) == 28


def test_json() -> None:
    text = '{\n "a": {"b": [1,\n  {"c": "}\\""},\n  3]},\n "d": null\n}'
    assert locate(text, "json", ("a", "b", 1, "c")) == 3
    assert locate(text, "json", ("a", "b", 2)) == 4
    assert locate(text, "json", ("d",)) == 5


_KEYS = st.text(min_size=1, max_size=5)
_TREES = st.recursive(
    st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.booleans() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(_KEYS, inner, max_size=4),
    max_leaves=12,
)


def _paths(tree: Any, path: tuple[str | int, ...] = ()) -> list[tuple[tuple[str | int, ...], Any]]:
    items = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    found: list[tuple[tuple[str | int, ...], Any]] = []
    for key, item in items:
        found += [((*path, key), item), *_paths(item, (*path, key))]
    return found


@STEADY
@given(st.dictionaries(_KEYS, _TREES, max_size=4))
def test_every_path_of_a_json_text_is_found_on_its_line(tree: dict[str, Any]) -> None:
    text = json.dumps(tree, indent=1)
    for path, item in _paths(tree):
        line = locate(text, "json", path)
        assert line is not None
        shown = text.split("\n")[line - 1]
        if isinstance(path[-1], str):
            assert shown.strip().startswith(json.dumps(path[-1]) + ":")
        elif not isinstance(item, (dict, list)):
            assert shown.strip().rstrip(",") == json.dumps(item)


def test_a_key_of_very_many_parts_ends() -> None:
    assert locate(".".join("a" * 100_000) + " = 1", "toml", ("a", "a", "b")) == 1


@STEADY
@given(st.text(max_size=200), st.sampled_from(["toml", "json"]))
def test_any_text_ends(text: str, syntax: str) -> None:
    line = locate(text, syntax, ("a", "b", 0))
    assert line is None or 1 <= line <= text.count("\n") + 1
