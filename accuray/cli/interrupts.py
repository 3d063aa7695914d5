"""Ctrl-C and SIGTERM: stop the render, keep what it has, and end with the status that tells why."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

_SIGNALS = (signal.SIGINT, signal.SIGTERM)


class Interrupts:
    """While entered, the first SIGINT or SIGTERM is remembered, and a second one raises KeyboardInterrupt.

    Inside `interruptible()` the first one raises it too. So an engine stops at once, an image is still written whole,
    and a user who insists is obeyed. A signal that the process was started to ignore stays ignored.
    """

    def __init__(self) -> None:
        self.signal: int | None = None
        self._interruptible = False
        self._before: dict[signal.Signals, Any] = {}  # the handlers to put back

    @property
    def status(self) -> int:
        """The exit status: 0, or 128 + the number of the first signal (130 for SIGINT, 143 for SIGTERM)."""
        return 0 if self.signal is None else 128 + self.signal

    def __enter__(self) -> Interrupts:
        for number in _SIGNALS:
            if signal.getsignal(number) is not signal.SIG_IGN:
                self._before[number] = signal.signal(number, self._receive)
        return self

    def __exit__(self, *_: object) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    @contextmanager
    def interruptible(self) -> Iterator[None]:
        """Lets the first signal end the block; one that has come already does so at its start."""
        if self.signal is not None:
            raise KeyboardInterrupt
        self._interruptible = True
        try:
            yield
        finally:
            self._interruptible = False

    def _receive(self, number: int, _frame: FrameType | None) -> None:
        is_first = self.signal is None
        if is_first:
            self.signal = number
        if self._interruptible or not is_first:
            raise KeyboardInterrupt
