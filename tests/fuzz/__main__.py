"""Fuzzes every reader and says what was found: `make fuzz`.

    python -m tests.fuzz [TARGET...]

FUZZ_SECONDS is the time for each target, 600 unless it is set; FUZZ_TARGETS names targets in place of arguments.
Findings lie in out/fuzz/findings; the status is 1 if there is one. `test_findings.py` says what becomes of it.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import re
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

from tests.fuzz import compiled, seeds
from tests.fuzz.readers import READERS

OUT = seeds.REPOSITORY / "out" / "fuzz"
FINDINGS = OUT / "findings"
LEAST_SECONDS = 2.0


@dataclass
class Outcome:
    """What came of fuzzing one target; ``findings`` are files, each with what was said when it was read."""

    runs: int = 0
    findings: dict[Path, str] = field(default_factory=dict)

    def keep(self, target: str, content: bytes, suffix: str, words: str) -> None:
        """Puts a finding where the developer finds it."""
        FINDINGS.mkdir(parents=True, exist_ok=True)
        path = FINDINGS / f"{target}-{hashlib.sha256(content).hexdigest()[:12]}{suffix}"
        path.write_bytes(content)
        self.findings[path] = words


def fuzz_compiled(target: str, seconds: float) -> Outcome:
    """LibFuzzer on one of the C++ targets. Its corpus stays for the next time."""
    program = compiled.build(target)
    corpus, artifacts = OUT / "corpus" / target, OUT / "artifacts" / target
    shutil.rmtree(artifacts, ignore_errors=True)
    for folder in (corpus, artifacts):
        folder.mkdir(parents=True, exist_ok=True)
    for number, content in enumerate(compiled.SEEDS[target]()):
        (corpus / f"seed{number}").write_bytes(content)
    (OUT / f"{target}.dict").write_bytes(compiled.dictionary(target))
    options = [f"-max_total_time={max(1, round(seconds))}", "-timeout=10", "-rss_limit_mb=2048", "-max_len=65536"]
    options += [f"-dict={OUT / target}.dict", f"-artifact_prefix={artifacts}/", "-print_final_stats=1"]
    done = subprocess.run([program, *options, corpus], capture_output=True, text=True, errors="replace", check=False)
    executed = re.search(r"number_of_executed_units: (\d+)", done.stderr)
    outcome = Outcome(int(executed[1]) if executed else 0)
    for path in artifacts.iterdir():
        outcome.keep(target, path.read_bytes(), f".{target}", done.stderr[-4000:])
    if done.returncode != 0 and not outcome.findings:
        outcome.keep(target, b"", ".none", done.stderr[-4000:])
    return outcome


def fuzz_python(target: str, seconds: float) -> Outcome:
    """Damaged files for a reader in child processes; one that ends early leaves a finding, and the next one goes on."""
    folder = OUT / "work" / target
    folder.mkdir(parents=True, exist_ok=True)
    outcome, end = Outcome(), time.monotonic() + seconds
    current = folder / f"current{READERS[target].suffix}"
    progress = folder / "runs"
    while (left := end - time.monotonic()) > LEAST_SECONDS or outcome.runs == 0:
        progress.write_text("0")
        command = [sys.executable, "-m", "tests.fuzz.child", "--seconds", str(left), "--seed", str(time.time_ns())]
        environment = os.environ | {"MALLOC_ARENA_MAX": "2", "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
        done = subprocess.run(
            [*command, folder, target], cwd=folder, env=environment, capture_output=True, text=True, errors="replace",
            check=False,
        )  # fmt: skip
        outcome.runs += int(progress.read_text())
        if done.returncode == 0:
            break
        outcome.keep(target, current.read_bytes(), READERS[target].suffix, done.stderr[-4000:])
        outcome.runs += 1
    return outcome


def main() -> int:
    """The command."""
    known = [*(f"c++:{name}" for name in compiled.SEEDS), *READERS]
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description="Fuzzes every reader.")
    parser.add_argument("targets", nargs="*", help=", ".join(known), metavar="TARGET")
    targets = parser.parse_args().targets or os.environ.get("FUZZ_TARGETS", "").split() or known
    if unknown := set(targets) - set(known):
        parser.error(f"no such target: {', '.join(sorted(unknown))}; there are {', '.join(known)}")
    seconds = float(os.environ.get("FUZZ_SECONDS", "600"))
    shutil.rmtree(FINDINGS, ignore_errors=True)
    print(f"{len(targets)} targets, {seconds:g} s each", flush=True)
    found: dict[Path, str] = {}
    for target in targets:
        name = target.removeprefix("c++:")
        outcome = (fuzz_compiled if name != target else fuzz_python)(name, seconds)
        print(f"{target:10} {outcome.runs:10} runs {len(outcome.findings):3} findings", flush=True)
        found |= outcome.findings
    for path, words in found.items():
        print(f"\n== {path}\n{words}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
