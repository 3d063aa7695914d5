"""Every broken scene of the table gives one SceneError that says where, what and what was allowed."""

from __future__ import annotations

from pathlib import Path

import pytest
from bad_scenes import BAD_SCENES, BadScene

from accuray.formats import load
from accuray.scene import SceneError


def test_table_is_large_and_its_names_differ() -> None:
    assert len(BAD_SCENES) >= 70
    assert len({case.name for case in BAD_SCENES}) == len(BAD_SCENES)


@pytest.mark.parametrize("case", BAD_SCENES, ids=lambda case: case.name)
def test_error_says_where_what_and_what_is_allowed(
    case: BadScene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    path = case.write(tmp_path)
    with pytest.raises(SceneError) as caught:
        load(path.relative_to(tmp_path), overrides=case.overrides)
    message = str(caught.value)
    assert [text for text in case.expected if text not in message] == [], message
    assert len(message) < 2000
