"""Makes one virtual environment per peer, outside the source tree, and says plainly what could not be installed.

``python -m benchmarks.setup_peers [--apt] [PEER ...]``
"""

import argparse
import os
import shutil
import subprocess
import sys
from pathlib import Path

from benchmarks import settings
from benchmarks.peers import environment, find_llvm, peers_folder, python_of

APT = ["apt-get", "install", "-y", "--no-install-recommends", "libllvm19"]
MODULES = {"mitsuba": "mitsuba", "cycles": "bpy", "luxcore": "pyluxcore"}


def main() -> int:
    """Set up the named peers, all by default; the exit code is 1 if any of them is not usable afterwards."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("peers", nargs="*", metavar="PEER", help=", ".join(settings.REQUIREMENTS))
    parser.add_argument("--apt", action="store_true", help="install the system's LLVM library for Mitsuba")
    arguments = parser.parse_args()
    if unknown := set(arguments.peers) - set(settings.REQUIREMENTS):
        parser.error(f"unknown peer {unknown.pop()!r}: allowed {', '.join(settings.REQUIREMENTS)}")
    failures = 0
    for peer in arguments.peers or settings.REQUIREMENTS:
        problem = install(peer)
        failures += bool(problem)
        print(f"{peer}: {problem or 'ready in ' + str(peers_folder() / peer)}", flush=True)
    llvm_missing = "mitsuba" in (arguments.peers or settings.REQUIREMENTS) and not provide_llvm(arguments.apt)
    return 1 if failures or llvm_missing else 0


def install(peer: str) -> str:
    """Create the environment, install the pinned packages, import the renderer; return what went wrong or ''."""
    folder = peers_folder() / peer
    folder.parent.mkdir(parents=True, exist_ok=True)
    steps = [] if python_of(peer).exists() else [_create(folder)]
    steps.append(_install(folder, settings.REQUIREMENTS[peer]))
    steps.append([str(python_of(peer)), "-c", f"import {MODULES[peer]}"])
    for step in steps:
        try:
            done = subprocess.run(step, capture_output=True, text=True, check=False, env=environment(peer))
        except FileNotFoundError:
            return f"{step[0]} not found: install uv or Python {settings.PEER_PYTHON}"
        if done.returncode != 0:
            return f"`{' '.join(step)}` failed:\n" + "\n".join((done.stderr or done.stdout).splitlines()[-6:])
    return ""


def _create(folder: Path) -> list[str]:
    if uv := shutil.which("uv"):
        return [uv, "venv", "--quiet", "--python", settings.PEER_PYTHON, str(folder)]
    ours = ".".join(map(str, sys.version_info[:2])) == settings.PEER_PYTHON
    return [sys.executable if ours else f"python{settings.PEER_PYTHON}", "-m", "venv", str(folder)]


def _install(folder: Path, packages: tuple[str, ...]) -> list[str]:
    python = str(folder / "bin" / "python")
    if uv := shutil.which("uv"):
        return [uv, "pip", "install", "--quiet", "--python", python, *packages]
    return [python, "-m", "pip", "install", "--quiet", *packages]


def provide_llvm(may_install: bool) -> bool:
    """Whether LLVM's library is there; installs it if asked to, else prints the line that would."""
    if find_llvm() is None and may_install:
        subprocess.run(APT if os.geteuid() == 0 else ["sudo", *APT], check=False)
    if (llvm := find_llvm()) is None:
        print(f"mitsuba: its LLVM variants need LLVM's shared library:\n    sudo {' '.join(APT)}")
        return False
    print(f"mitsuba: uses {llvm}")
    return True


if __name__ == "__main__":
    sys.exit(main())
