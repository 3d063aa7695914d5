"""Links between pages, to code and to pictures lead to files that exist; headings that are linked to, too."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest
from pages import BLOCK, PAGES, REPOSITORY, name_of

LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
LARGEST_PICTURE = 512_000


def links(page: Path) -> list[str]:
    """Relative links of a page, outside of fenced blocks."""
    text = BLOCK.sub("", page.read_text(encoding="utf-8"))
    return [target for target in LINK.findall(text) if "://" not in target and not target.startswith("mailto:")]


def anchors(page: Path) -> set[str]:
    """Names of the headings of a page, as links spell them."""
    headings = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_links_lead_somewhere(page: Path) -> None:
    for link in links(page):
        path, _, anchor = link.partition("#")
        target = (page.parent / path).resolve() if path else page
        assert target.exists(), f"{link} is not there"
        assert target.is_relative_to(REPOSITORY), f"{link} leaves the repository"
        if anchor:
            assert anchor in anchors(target), f"{link}: no such heading"


def test_every_page_is_linked_from_another() -> None:
    linked = {(page.parent / link.partition("#")[0]).resolve() for page in PAGES for link in links(page)}
    below = {folder for target in linked for folder in [target] if target.is_dir()}
    lonely = [page for page in PAGES if page not in linked and page.parent not in below and page.name != "README.md"]
    assert [name_of(page) for page in lonely] == []


def test_linked_files_are_in_the_repository() -> None:
    """What exists only here, because git ignores it, is a dead link for everybody else."""
    targets = {(page.parent / link.partition("#")[0]).resolve() for page in PAGES for link in links(page)}
    names = [str(target.relative_to(REPOSITORY)) for target in targets]
    ignored = subprocess.run(
        ["git", "check-ignore", *names], cwd=REPOSITORY, capture_output=True, text=True, check=False
    )
    assert ignored.stdout == ""


@pytest.mark.parametrize("picture", sorted((REPOSITORY / "docs/pictures").iterdir()), ids=lambda path: path.name)
def test_pictures_are_small_and_used(picture: Path) -> None:
    assert picture.stat().st_size <= LARGEST_PICTURE
    assert any(link.endswith(f"pictures/{picture.name}") for page in PAGES for link in links(page))
