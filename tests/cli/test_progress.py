"""The three displays of progress."""

from __future__ import annotations

import io
import json
import math
import re

import pytest
from fake_engine import progress

from accuray.cli.progress import Display, JsonDisplay, LiveDisplay, LogDisplay, choose_display, duration

# What farm managers look for.
PROGRESS_LINE = re.compile(r"^Progress: (\d+)% (\d+)/(\d+) spp (\S+)<(\S+)")


class Clock:
    """A clock that the test moves."""

    now = 0.0

    def __call__(self) -> float:
        return self.now


class Terminal(io.StringIO):
    """A stream that says it is a terminal."""

    def isatty(self) -> bool:
        return True


def test_log_has_a_line_every_ten_seconds_and_the_last_one() -> None:
    stream, clock = io.StringIO(), Clock()
    display = LogDisplay(stream, clock)
    for second in range(35):
        clock.now = float(second)
        display(progress(second, 100, elapsed=float(second), eta=99.0 - second))
    display.close()
    found = [PROGRESS_LINE.match(line) for line in stream.getvalue().splitlines()]
    assert [match.groups() for match in found if match] == [
        ("10", "10", "100", "00:10", "01:29"),
        ("20", "20", "100", "00:20", "01:19"),
        ("30", "30", "100", "00:30", "01:09"),
        ("34", "34", "100", "00:34", "01:05"),
    ]
    assert all(found)


@pytest.mark.parametrize(("done", "percent"), [(0, "0"), (639, "99"), (640, "100")])
def test_hundred_percent_means_all(done: int, percent: str) -> None:
    stream = io.StringIO()
    display = LogDisplay(stream, Clock())
    display(progress(done, 640))
    display.close()
    assert stream.getvalue().startswith(f"Progress: {percent}% {done}/640 spp")


def test_live_line_redraws_itself_and_ends() -> None:
    stream, clock = Terminal(), Clock()
    display = LiveDisplay(stream, clock)
    for step in range(100):
        clock.now = 0.01 * step
        display(progress(step + 1, 100))
    display.close()
    drawn = stream.getvalue()
    assert drawn.endswith("\n")
    frames = drawn.rstrip("\n").split("\r\x1b[K")[1:]
    assert 9 <= len(frames) <= 12
    assert "100% 100/100 spp" in frames[-1]
    assert "5.20 Mrays/s, error 1.8 %" in frames[-1]
    assert "left" in frames[0]
    assert all("\n" not in frame and len(frame) < 80 for frame in frames)


def test_live_line_fits_a_narrow_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("accuray.cli.progress.terminal_columns", lambda _: 30)
    stream = Terminal()
    display = LiveDisplay(stream, Clock())
    display(progress(50, 100))
    assert len(stream.getvalue().removeprefix("\r\x1b[K")) < 30


def test_display_without_progress_prints_nothing() -> None:
    for kind in (Display, LogDisplay, LiveDisplay, JsonDisplay):
        stream = Terminal()
        kind(stream).close()
        assert stream.getvalue() == ""


def test_json_writes_null_for_what_is_not_known() -> None:
    stream = io.StringIO()
    display = JsonDisplay(stream, Clock())
    display(progress(0, 64, eta=None, error=math.nan))
    display.close()
    record = json.loads(stream.getvalue())
    assert record["eta"] is None
    assert record["error"] is None
    assert (record["done"], record["total"], record["rays"]) == (0, 64, 5_200_000)


def test_display_fits_the_stream() -> None:
    assert type(choose_display("auto", False, Terminal())) is LiveDisplay
    assert type(choose_display("auto", False, io.StringIO())) is LogDisplay
    assert choose_display("auto", True, Terminal()) is None
    assert type(choose_display("json", True, Terminal())) is JsonDisplay


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(0, "00:00"), (59.6, "01:00"), (754, "12:34"), (36_061, "10:01:01"), (None, "--:--"), (math.inf, "--:--")],
)
def test_duration(seconds: float | None, text: str) -> None:
    assert duration(seconds) == text
