"""What is generated is up to date, what is said in two places is the same, and what is cited is in the bibliography."""

from __future__ import annotations

import re
import tomllib
import unicodedata
from pathlib import Path

import pytest
from pages import PAGES, REPOSITORY, name_of

import accuray

CITING = (".h", ".cpp", ".cu", ".py", ".toml")
# "Wilkie et al. 2014", "Veach and Guibas 1995", "Ernst, Stamminger and Greiner 2006", "Goral et al. (1984)"
NAME = r"[A-Z][\w'-]+"
CITATION = re.compile(rf"({NAME}(?:, {NAME})*(?:,? and {NAME}| et al\.)?),? \(?(1[6-9]\d\d|20[0-2]\d)\b")
# Words that stand before a year and name no author.
NO_AUTHORS = {"Sellmeier", "S"}


def test_reference_page_is_up_to_date() -> None:
    pytest.importorskip("accuray._core", reason="the compiled module is not built")
    written = (REPOSITORY / "docs/reference.md").read_text(encoding="utf-8")
    assert written == accuray.reference_markdown(), "run: accuray schema --reference > docs/reference.md"


def test_version_is_said_once() -> None:
    project = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert project["version"] == accuray.__version__, "accuray/data/version.py and pyproject.toml differ"


def plain(text: str) -> str:
    """Text in ASCII: accents of BibTeX and Unicode are dropped."""
    text = re.sub(r"\\(?:['\"`^~=.v]|[uvHc](?=\W))\s*|[{}]", "", text)
    return unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()


def bibliography() -> list[tuple[str, str]]:
    """Authors and year of every entry."""
    text = (REPOSITORY / "docs/references.bib").read_text(encoding="utf-8")
    entries = re.split(r"^@", text, flags=re.MULTILINE)[1:]
    found = []
    for entry in entries:
        author = re.search(r"author\s*=\s*\{(.*?)\},?\n", entry, re.DOTALL)
        year = re.search(r"year\s*=\s*\{?(\d{4})", entry)
        assert author is not None, entry
        assert year is not None, entry
        found.append((plain(author[1]), year[1]))
    return found


def cited(path: Path) -> set[tuple[str, str]]:
    """First author and year of what a file cites; a citation may run over the end of a line of comment."""
    text = re.sub(r"\n\s*(?://|#|\*)?\s*", " ", path.read_text(encoding="utf-8"))
    names = ((re.split(r",| and | et al", match[1])[0], match[2]) for match in CITATION.finditer(plain(text)))
    return {(name.removesuffix("'s").rpartition("_")[2], year) for name, year in names if name not in NO_AUTHORS}


def test_what_is_cited_is_in_the_bibliography() -> None:
    known = bibliography()
    missing = set()
    rooms = (REPOSITORY / room for room in ("src", "accuray", "scenes", "benchmarks", "examples"))
    for path in (path for room in rooms for path in room.rglob("*") if path.suffix in CITING):
        for name, year in cited(path):
            if not any(year == other and name in authors for authors, other in known):
                missing.add(f"{path.relative_to(REPOSITORY)}: {name} {year}")
    assert sorted(missing) == [], "add them to docs/references.bib"


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_pages_cite_what_is_in_the_bibliography(page: Path) -> None:
    known = bibliography()
    text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    for match in re.finditer(
        rf"\(({NAME}(?:, {NAME})*(?: and {NAME}| et al\.)?) (1[6-9]\d\d|20[0-2]\d)\)", plain(text)
    ):
        first = re.split(r",| and | et al", match[1])[0]
        assert any(match[2] == year and first in authors for authors, year in known), match[0]


def test_the_entries_have_keys_of_their_own() -> None:
    keys = re.findall(r"^@\w+\{(.+),$", (REPOSITORY / "docs/references.bib").read_text(encoding="utf-8"), re.MULTILINE)
    assert len(keys) == len(set(keys)) > 20
