"""How far a render is, told on standard error: a live line, a line now and then, or JSON.

A display is called with the engine's progress as often as the engine likes and decides itself what to show. `close` is
called once, however the render ended, and leaves the cursor at the start of a line.
"""

from __future__ import annotations

import json
import math
import os
import time
from collections.abc import Callable
from typing import Protocol, TextIO

LIVE_INTERVAL = 0.1  # seconds between redraws of the live line
JSON_INTERVAL = 0.5
LOG_INTERVAL = 10.0
BAR_WIDTH = 24


class Progress(Protocol):
    """What the engine reports (`accuray.render`); rates per second, times in seconds, unknown values NaN or None."""

    @property
    def done(self) -> int:
        """Samples per pixel so far."""

    @property
    def total(self) -> int:
        """Samples per pixel asked for."""

    @property
    def elapsed(self) -> float:
        """Time since rendering began."""

    @property
    def eta(self) -> float | None:
        """Time that is left, as estimated."""

    @property
    def rays(self) -> int:
        """Rays traced so far."""

    @property
    def rays_per_second(self) -> float:
        """Mean rate of rays."""

    @property
    def samples_per_second(self) -> float:
        """Mean rate of samples, of all pixels together."""

    @property
    def error(self) -> float | None:
        """Relative standard error of the picture, as estimated."""


class Display:
    """What all displays share: at most one output per interval, and always the last state.

    `frame` is the number of the frame that is rendered, None for a picture by itself.
    """

    interval = math.inf
    frame: int | None = None

    def __init__(self, stream: TextIO, clock: Callable[[], float] = time.monotonic) -> None:
        self.stream = stream
        self._clock = clock
        self._next = clock()
        self._unshown: Progress | None = None

    def __call__(self, progress: Progress) -> None:
        """Takes a new state and shows it if it is time to."""
        self._unshown = progress
        now = self._clock()
        if now >= self._next:
            self._next = now + self.interval
            self._flush()

    def close(self) -> None:
        """Shows the last state, if it has not been shown."""
        self._flush()

    def show(self, progress: Progress) -> None:
        """Prints one state."""

    @property
    def label(self) -> str:
        """What stands before the state of a frame."""
        return "" if self.frame is None else f"frame {self.frame}: "

    def _flush(self) -> None:
        if self._unshown is not None:
            self.show(self._unshown)
            self._unshown = None


class LogDisplay(Display):
    """A line every ten seconds, for files and farm managers; they find the numbers with one regular expression."""

    interval = LOG_INTERVAL

    def __init__(self, stream: TextIO, clock: Callable[[], float] = time.monotonic) -> None:
        super().__init__(stream, clock)
        self._next += self.interval  # a short render needs no line but the last

    def show(self, progress: Progress) -> None:
        """Prints `Progress: 35% 224/640 spp 00:12<00:22 5.20 Mrays/s, error 1.8 %`."""
        times = f"{duration(progress.elapsed)}<{duration(progress.eta)}"
        head = f"{self.label}Progress: {percent(progress)}% {progress.done}/{progress.total} spp {times}"
        print(head, figures(progress), file=self.stream, flush=True)


class LiveDisplay(Display):
    """One line that redraws itself, for terminals."""

    interval = LIVE_INTERVAL
    _drawn = False

    def show(self, progress: Progress) -> None:
        """Redraws the line, without its bar where the terminal is narrow."""
        share = progress.done / progress.total if progress.total else 1.0
        filled = round(share * BAR_WIDTH)
        bar = "[" + "#" * filled + "-" * (BAR_WIDTH - filled) + "] "
        left = "done in " + duration(progress.elapsed) if share >= 1 else duration(progress.eta) + " left"
        text = f"{self.label}{percent(progress):3d}% {progress.done}/{progress.total} spp  {figures(progress)}  {left}"
        columns = terminal_columns(self.stream)
        if len(bar) + len(text) < columns:
            text = bar + text
        self.stream.write("\r\x1b[K" + text[: columns - 1])
        self.stream.flush()
        self._drawn = True

    def close(self) -> None:
        """Shows the last state and ends the line."""
        super().close()
        if self._drawn:
            self.stream.write("\n")
            self.stream.flush()


class JsonDisplay(Display):
    """One JSON object per line, for programs; a figure that is not known is null."""

    interval = JSON_INTERVAL

    def show(self, progress: Progress) -> None:
        """Prints the state with the names of `Progress`, and the frame if there is one."""
        record: dict[str, int | float | None] = {} if self.frame is None else {"frame": self.frame}
        record |= {"done": progress.done, "total": progress.total, "rays": progress.rays}
        for name in ("elapsed", "eta", "samples_per_second", "rays_per_second", "error"):
            value: float | None = getattr(progress, name)
            record[name] = round(value, 9) if value is not None and math.isfinite(value) else None
        print(json.dumps(record), file=self.stream, flush=True)


def choose_display(style: str, quiet: bool, stream: TextIO, frame: int | None = None) -> Display | None:
    """The display for a stream. `style`: "json", or "auto" for what fits the stream and the wish for quiet.

    None for silence: an engine without a display need not estimate errors for it. `frame`: number of the frame.
    """
    display: Display
    if style == "json":
        display = JsonDisplay(stream)
    elif quiet:
        return None
    else:
        display = LiveDisplay(stream) if stream.isatty() else LogDisplay(stream)
    display.frame = frame
    return display


def percent(progress: Progress) -> int:
    """The share that is done, rounded down, so that 100 means all of it."""
    return 100 * progress.done // progress.total if progress.total else 100


def figures(progress: Progress) -> str:
    """Speed and error in words: `5.20 Mrays/s, error 1.8 %`."""
    text = f"{progress.rays_per_second / 1e6:.2f} Mrays/s"
    if progress.error is not None and math.isfinite(progress.error):
        error = 100 * progress.error
        text += f", error {error:.2g} %" if error < 99.5 else f", error {error:.0f} %"
    return text


def duration(seconds: float | None) -> str:
    """Seconds as `mm:ss` or `h:mm:ss`; `--:--` if unknown."""
    if seconds is None or not math.isfinite(seconds):
        return "--:--"
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes:02d}:{rest:02d}"


def terminal_columns(stream: TextIO) -> int:
    """The width of the terminal behind a stream; 80 if it does not tell."""
    try:
        return os.get_terminal_size(stream.fileno()).columns or 80
    except (OSError, ValueError):
        return 80
