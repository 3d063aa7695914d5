"""Markdown tables, and the ratios to the peers that AccuRay is held to."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

Row = Mapping[str, Any]


def table(rows: Sequence[Row], columns: Mapping[str, str]) -> str:
    """Markdown table; ``columns`` maps a row's key to ``heading`` or ``heading|format``. Missing values print as -."""
    headings = [spec.split("|")[0] for spec in columns.values()]
    lines = ["| " + " | ".join(headings) + " |", "|" + "---|" * len(headings)]
    for row in rows:
        cells = [_cell(row.get(key), spec.partition("|")[2]) for key, spec in columns.items()]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def _cell(value: Any, form: str) -> str:
    if value is None:
        return "-"
    if isinstance(value, list | tuple):
        return ", ".join(format(item, form) for item in value)
    return format(value, form) if form else str(value).replace("\n", " ").replace("|", "/")


@dataclass(frozen=True)
class Target:
    """``ours`` must be at least ``factor`` times the best row whose renderer starts with ``against``."""

    benchmark: str
    figure: str
    against: str
    factor: float
    sentence: str


COMPILED = (
    ("mitsuba:llvm_ad_spectral", "Mitsuba llvm_ad_spectral"),
    ("mitsuba:llvm_ad_rgb", "Mitsuba llvm_ad_rgb"),
    ("cycles", "Cycles"),
)
SCALAR = (
    ("mitsuba:scalar_spectral", "Mitsuba scalar_spectral"),
    ("mitsuba:scalar_rgb", "Mitsuba scalar_rgb"),
    ("cycles", "Cycles"),
)
EQUAL_ERROR = (
    ("glossy", "rough metal over a textured floor", COMPILED),
    ("frosted", "rough glass", COMPILED),
    ("environment", "environment map", COMPILED),
    ("interior", "room behind a window", COMPILED),
    ("lamps", "10 000 lamps", COMPILED),
    ("instanced", "4000 instances", SCALAR),
)
"""Scenes in which AccuRay shall be ahead of every one of these peers."""

TARGETS = (
    Target("cornell", "samples_per_s", "mitsuba:llvm_ad_spectral", 1.0, "samples/s of Mitsuba llvm_ad_spectral"),
    Target("cornell", "samples_per_s", "cycles", 4.0, "samples/s of Cycles"),
    Target("efficiency", "efficiency", "mitsuba:llvm_ad_spectral", 2.0, "efficiency of Mitsuba llvm_ad_spectral"),
    Target("efficiency", "efficiency", "cycles", 30.0, "efficiency of Cycles"),
    *(
        Target(scene, "efficiency", peer, 1.0, f"efficiency of {name}, {what}")
        for scene, what, others in EQUAL_ERROR
        for peer, name in others
    ),
    Target("million", "samples_per_s", "", 1.0, "samples/s of the fastest peer, 1 M triangles"),
)


def ratios(results: Mapping[str, Sequence[Row]]) -> list[dict[str, Any]]:
    """AccuRay's figure over the best peer's, for every target whose two sides were measured."""
    found = []
    for target in TARGETS:
        rows = [row for row in results.get(target.benchmark, ()) if row.get(target.figure) is not None]
        ours = [row[target.figure] for row in rows if row["renderer"] == "accuray"]
        theirs = [
            row[target.figure]
            for row in rows
            if row["renderer"] != "accuray" and row["renderer"].startswith(target.against)
        ]
        if ours and theirs:
            ratio = ours[0] / max(theirs)
            found.append(
                {"what": target.sentence, "ratio": ratio, "wanted": target.factor, "met": ratio >= target.factor}
            )
    return found


def limits(figures: Sequence[tuple[str, float, float, bool]]) -> list[dict[str, Any]]:
    """Rows for plain limits: (what, measured, limit, whether the limit is an upper one)."""
    return [
        {"what": what, "measured": measured, "limit": limit, "met": measured <= limit if upper else measured >= limit}
        for what, measured, limit, upper in figures
    ]


RATIO_COLUMNS = {"what": "AccuRay's ratio to", "ratio": "ratio|.2f", "wanted": "wanted|.2f", "met": "met"}
LIMIT_COLUMNS = {"what": "what", "measured": "measured|.3g", "limit": "limit|.3g", "met": "met"}
