"""SIGINT and SIGTERM: the render stops, the image so far is written, and the exit status tells which it was."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from fake_engine import FakeEngine, FakeImage

from accuray.cli import main
from accuray.cli.interrupts import Interrupts

SIGNALS = [(signal.SIGINT, 130), (signal.SIGTERM, 143)]


@pytest.fixture(autouse=True)
def handlers() -> Iterator[None]:
    """Fails a test that leaves another handler behind than it found."""
    before = [signal.getsignal(number) for number, _ in SIGNALS]
    yield
    assert [signal.getsignal(number) for number, _ in SIGNALS] == before


@pytest.mark.parametrize(("number", "status"), SIGNALS)
def test_interrupted_render_writes_what_it_has(
    number: signal.Signals, status: int, engine: FakeEngine, capsys: pytest.CaptureFixture[str]
) -> None:
    def interrupt(_: dict[str, Any]) -> None:
        signal.raise_signal(number)

    engine.on_render = interrupt
    assert main(["render", "box.toml"]) == status
    assert Path("box.exr").exists()
    assert Path("box.png").exists()
    captured = capsys.readouterr()
    assert captured.out == "box.exr\nbox.png\n"
    assert "interrupted; the image so far has been written" in captured.err


@pytest.mark.parametrize(("number", "status"), SIGNALS)
def test_signal_while_writing_lets_the_writing_end(
    number: signal.Signals, status: int, engine: FakeEngine, monkeypatch: pytest.MonkeyPatch
) -> None:
    save = FakeImage.save

    def interrupted_save(image: FakeImage, path: Path) -> None:
        if Path(path).suffix == ".exr":
            signal.raise_signal(number)
        save(image, path)

    monkeypatch.setattr(FakeImage, "save", interrupted_save)
    assert main(["render", "box.toml"]) == status
    assert Path("box.exr").exists()
    assert Path("box.png").exists()


def test_second_signal_ends_the_writing(
    engine: FakeEngine, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def interrupt(*_: object) -> None:
        signal.raise_signal(signal.SIGTERM)

    engine.on_render = interrupt
    monkeypatch.setattr(FakeImage, "save", interrupt)
    assert main(["render", "box.toml"]) == 143
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "interrupted before there was an image" in captured.err


def test_signal_while_loading_ends_without_an_image(engine: FakeEngine, monkeypatch: pytest.MonkeyPatch) -> None:
    import accuray

    def interrupted_load(*_: object, **__: object) -> None:
        signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(accuray, "load", interrupted_load)
    assert main(["render", "box.toml"]) == 130
    assert engine.rendered == []
    assert list(Path().iterdir()) == []


def test_interrupt_before_the_first_sample_writes_nothing(
    engine: FakeEngine, capsys: pytest.CaptureFixture[str]
) -> None:
    def interrupt(_: dict[str, Any]) -> None:
        engine.finished = False
        signal.raise_signal(signal.SIGINT)

    engine.on_render = interrupt
    assert main(["render", "box.toml"]) == 130
    assert list(Path().iterdir()) == []
    assert "interrupted before there was an image" in capsys.readouterr().err


def test_signal_between_two_steps_ends_the_next() -> None:
    with Interrupts() as interrupts:
        signal.raise_signal(signal.SIGINT)
        with pytest.raises(KeyboardInterrupt), interrupts.interruptible():
            pytest.fail("the block has begun")
    assert interrupts.status == 130


def test_ignored_signal_stays_ignored() -> None:
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with Interrupts() as interrupts, interrupts.interruptible():
            signal.raise_signal(signal.SIGINT)
        assert interrupts.status == 0
    finally:
        signal.signal(signal.SIGINT, before)
