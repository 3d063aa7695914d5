"""`accuray doctor`: what AccuRay finds on this machine, and whether it can work with it."""

from __future__ import annotations

import os
import platform
import sys
from argparse import Namespace
from collections.abc import Callable, Iterator
from pathlib import Path

from .parser import Parser, UsageError
from .threads import control_group_quota, thread_count

SUMMARY = "Check this installation and this machine; print versions."

# What the x86-64-v3 instruction set needs, as Linux names it.
REQUIRED_CPU_FLAGS = frozenset({"avx", "avx2", "bmi1", "bmi2", "f16c", "fma", "abm", "movbe"})

Check = tuple[str, bool, str]


def configure(parser: Parser) -> None:
    """`accuray doctor` has no flags."""


def run(_options: Namespace) -> int:
    """Prints one line per check; the status is 1 if one fails."""
    failures = 0
    for name, passed, text in checks():
        failures += not passed
        print(f"{'ok  ' if passed else 'FAIL'}  {name:<12} {text}")
    print("all is well" if not failures else f"{failures} of these need attention")
    return 1 if failures else 0


def checks() -> Iterator[Check]:
    """Yields (what, whether it will do, what was found). The processor comes first: it must run what follows."""
    yield "python", True, f"{platform.python_version()} ({sys.executable})"
    model, flags = processor()
    missing = REQUIRED_CPU_FLAGS - flags
    if flags and missing:
        yield "processor", False, f"{model} lacks {', '.join(sorted(missing))}: AccuRay needs x86-64-v3"
        return
    yield "processor", True, f"{model}, {os.cpu_count()} threads"
    yield guarded("engine", engine)
    yield guarded("threads", threads)
    yield guarded("cache", cache)
    yield guarded("files", files)


def guarded(name: str, check: Callable[[], str]) -> Check:
    """Runs a check that raises if it fails."""
    try:
        return name, True, check()
    except (ImportError, OSError, RuntimeError, ValueError, UsageError) as error:
        return name, False, f"{type(error).__name__}: {error}"


def engine() -> str:
    """The compiled part loads; its versions."""
    import accuray

    facts = accuray.build_info()
    return f"AccuRay {accuray.__version__}, " + ", ".join(f"{name} {value}" for name, value in facts.items())


def threads() -> str:
    """How many threads a render takes, and the limit that is the reason if there is one."""
    quota = control_group_quota()
    limit = "" if quota is None else f" (this control group may use {quota:g} processors)"
    return f"{thread_count(None)} by default{limit}"


def cache() -> str:
    """The cache folder can be made and written to."""
    import accuray

    folder = accuray.cache_folder()
    folder.mkdir(parents=True, exist_ok=True)
    accuray.probe_writable(folder / "probe")
    return str(folder)


def files() -> str:
    """The libraries that write images load."""
    import OpenEXR

    return f"OpenEXR {OpenEXR.__version__}"


def processor(listing: Path = Path("/proc/cpuinfo")) -> tuple[str, frozenset[str]]:
    """Model and instruction set flags of the processor; no flags where the system does not list them."""
    try:
        lines = listing.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return platform.processor() or platform.machine(), frozenset()
    first: dict[str, str] = {}  # what is said of the first of the processors, which are all alike
    for line in lines:
        key, colon, value = line.partition(":")
        if colon:
            first.setdefault(key.strip(), value.strip())
    return first.get("model name", platform.machine()), frozenset(first.get("flags", "").split())
