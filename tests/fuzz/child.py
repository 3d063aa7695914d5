"""Damages the files of readers and reads them, in this process, which may crash.

    python -m tests.fuzz.child FOLDER [--seconds S | --runs N] [--sweep STEPS] [--seed K] READER...

Before each attempt the file is in FOLDER/current.SUFFIX, for the one that is the last; FOLDER/runs says how many there
were. A read that takes ten seconds of the processor, a minute, or two GiB more than this process had, ends it.
Writes a JSON object: per reader how many files were read and refused, the longest message, and the kinds of messages.
"""

from __future__ import annotations

import argparse
import faulthandler
import json
import random
import re
import resource
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tests.fuzz.readers import READERS, Reader

CPU_SECONDS = 10.0
WALL_SECONDS = 60.0
"""A read that takes more is a hang; a busy machine takes nobody's processor time, but makes everyone wait."""
ROOM = 2 << 30
MOST_MEMBERS = 3000


def limit_memory(room: int) -> None:
    """From now on this process may take as many bytes more than it has."""
    size = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (size + room, resource.getrlimit(resource.RLIMIT_AS)[1]))


def report_ends() -> None:
    """Crashes and hangs say where they happened before they end this process."""
    faulthandler.enable()
    for number in (signal.SIGALRM, signal.SIGPROF):
        faulthandler.register(number, chain=True)


def attempt(reader: Reader, folder: Path, content: bytes) -> str | None:
    """Reads the content as a file: None if it is one, else the message. Anything but the reader's errors ends us."""
    path = folder / f"current{reader.suffix}"
    path.write_bytes(content)
    with watched():
        try:
            reader.read(path)
        except reader.errors as error:
            return str(error)
    return None


@contextmanager
def watched() -> Iterator[None]:
    """Ends this process, with a report of where it was, if what is inside takes too long."""
    signal.setitimer(signal.ITIMER_PROF, CPU_SECONDS)
    signal.setitimer(signal.ITIMER_REAL, WALL_SECONDS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.setitimer(signal.ITIMER_REAL, 0)


def sweeps(content: bytes, steps: int) -> Iterator[bytes]:
    """The file cut off, and with a bit flipped, in so many places; at every byte of one that has no more."""
    step = max(1, len(content) // steps)
    yield from (content[:end] for end in range(0, len(content), step))
    for at in range(0, len(content), step):
        yield content[:at] + bytes([content[at] ^ (1 << at // step % 8)]) + content[at + 1 :]


def mutants(reader: Reader, rng: random.Random, members: list[bytes]) -> Iterator[bytes]:
    """Damaged members, without an end. The caller adds those that led to something new."""
    while True:
        # The seeds stay in play however many members there are.
        pool = members if rng.random() < 0.7 else reader.seeds()
        yield reader.damage(rng.choice(pool), rng)


def kind_of(message: str | None) -> str:
    """A message without what differs from file to file: a reader in the same state says the same."""
    return "read" if message is None else re.sub(r"\d+|\"[^\"]*\"|'[^']*'", "_", message)[:160]


def fuzz(name: str, given: argparse.Namespace) -> dict[str, Any]:
    """Damages a reader's files until the time or the number is over. A file with a new message becomes a member."""
    reader, folder, rng = READERS[name], given.folder, random.Random(f"{given.seed} {name}")
    members = list(reader.seeds())
    for content in members:
        problem = attempt(reader, folder, content)
        if problem is not None:
            raise ValueError(f"a seed of {name} is refused: {problem}")
    kinds: dict[str, int] = {}
    longest, done, end = 0, 0, time.monotonic() + given.seconds
    limit_memory(ROOM)
    swept = (content for seed in reader.seeds() for content in sweeps(seed, given.sweep))
    for source in (swept, mutants(reader, rng, members)):
        least = done + (given.runs if source is not swept else 0)
        for content in source:
            if time.monotonic() >= end or (source is not swept and done >= least):
                break
            message = attempt(reader, folder, content)
            kind = kind_of(message)
            if kind not in kinds and len(members) < MOST_MEMBERS:
                members.append(content)
            kinds[kind] = kinds.get(kind, 0) + 1
            longest = max(longest, len(message or ""))
            done += 1
            if done % 64 == 0:
                (folder / "runs").write_text(str(done))
    (folder / "runs").write_text(str(done))
    return {"runs": done, "read": kinds.get("read", 0), "longest": longest, "kinds": len(kinds)}


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seconds", type=float, default=float("inf"))
    parser.add_argument("--runs", type=int, default=1 << 62)
    parser.add_argument("--sweep", type=int, default=4096)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("readers", nargs="+", choices=sorted(READERS))
    given = parser.parse_args()
    report_ends()
    for name in given.readers:
        (given.folder / "reader").write_text(name)
        print(json.dumps({name: fuzz(name, given)}), flush=True)


if __name__ == "__main__":
    main()
