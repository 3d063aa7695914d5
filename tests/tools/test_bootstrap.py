"""tools/bootstrap.sh on machines that lack something, each made of a folder with the few commands it has."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
from trees import REPOSITORY

ALWAYS_THERE = ("bash", "cat", "dirname", "env", "uname")
RECORD = 'echo "$(basename "$0") $*" >>"$CALLS"\n'


class Machine:
    """A machine with a copy of the script and nothing installed."""

    def __init__(self, root: Path) -> None:
        self.commands = root / "bin"
        self.commands.mkdir()
        self.calls = root / "calls"
        self.script = root / "checkout" / "tools" / "bootstrap.sh"
        self.script.parent.mkdir(parents=True)
        shutil.copy(REPOSITORY / "tools" / "bootstrap.sh", self.script)
        for name in (*ALWAYS_THERE, "basename"):
            found = shutil.which(name)
            assert found is not None
            (self.commands / name).symlink_to(found)
        self.has("id", "echo 0\n")

    def has(self, name: str, body: str) -> None:
        """Gives the machine a command, written in shell."""
        path = self.commands / name
        path.write_text(f"#!/usr/bin/env bash\n{body}")
        path.chmod(0o755)

    def run(self) -> subprocess.CompletedProcess[str]:
        """Runs the script with only the machine's commands."""
        environment = {"PATH": str(self.commands), "CALLS": str(self.calls)}
        command = [str(self.commands / "bash"), str(self.script)]
        return subprocess.run(command, env=environment, capture_output=True, text=True, check=False, timeout=60)


@pytest.fixture
def machine(tmp_path: Path) -> Machine:
    """A bare machine, its user root."""
    return Machine(tmp_path)


def test_other_platform_is_told_what_to_install(machine: Machine) -> None:
    result = machine.run()
    assert result.returncode == 1
    for text in ("libembree-dev", "libtbb-dev", "C++20 compiler", "Python 3.11", "www.embree.org"):
        assert text in result.stderr


def test_other_processor_is_told_so(machine: Machine) -> None:
    (machine.commands / "uname").unlink()
    machine.has("uname", "echo riscv64\n")
    result = machine.run()
    assert result.returncode == 1
    assert "riscv64" in result.stderr


def test_user_without_sudo_is_told_the_command(machine: Machine) -> None:
    machine.has("id", "echo 1000\n")
    machine.has("apt-get", RECORD)
    result = machine.run()
    assert result.returncode == 1
    assert "apt-get install g++" in result.stderr
    assert not machine.calls.exists()


def test_lists_are_fetched_only_after_an_installation_has_failed(machine: Machine) -> None:
    machine.has("apt-get", RECORD + 'case "$*" in *install*) exit 100;; esac\n')
    result = machine.run()
    assert result.returncode == 1
    assert "apt-get could not install: g++" in result.stderr
    kinds = [
        word
        for line in machine.calls.read_text().splitlines()
        for word in line.split()
        if word in ("install", "update")
    ]
    assert kinds == ["install", "update", "install"]


def test_user_with_sudo_installs_by_it(machine: Machine) -> None:
    machine.has("id", "echo 1000\n")
    machine.has("apt-get", RECORD)
    machine.has("sudo", RECORD)
    result = machine.run()
    assert result.returncode == 1
    assert "still missing after their installation" in result.stderr
    (call,) = machine.calls.read_text().splitlines()
    assert call.startswith("sudo DEBIAN_FRONTEND=noninteractive apt-get")
    assert "libembree-dev" in call
