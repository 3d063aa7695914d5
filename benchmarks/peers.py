"""Where the renderers live and how a job is handed to one of them."""

import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from benchmarks.settings import Contender

DRIVERS = Path(__file__).parent / "drivers"
PEERS = ("accuray", "mitsuba", "cycles", "luxcore")
LLVM_VARIABLE = "DRJIT_LIBLLVM_PATH"


def peers_folder() -> Path:
    """Folder of the peers' virtual environments: ``$ACCURAY_PEERS``, else ``accuray/peers`` in the user's cache."""
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return Path(os.environ.get("ACCURAY_PEERS") or cache / "accuray" / "peers")


def python_of(peer: str) -> Path:
    """The interpreter that ``peer`` is imported with: this one for AccuRay, its own environment's for the others."""
    return Path(sys.executable) if peer == "accuray" else peers_folder() / peer / "bin" / "python"


def missing(peer: str) -> str:
    """Why ``peer`` cannot run; empty if it can."""
    if not python_of(peer).exists():
        return "not installed: run `python -m benchmarks.setup_peers`"
    if peer == "mitsuba" and find_llvm() is None:
        return f"needs LLVM: apt-get install libllvm19, or set {LLVM_VARIABLE}"
    return ""


def find_llvm() -> Path | None:
    """LLVM's shared library for Mitsuba's compiled variants: the variable's, else the newest in the system folders."""
    if named := os.environ.get(LLVM_VARIABLE):
        return Path(named)
    found: dict[float, Path] = {}
    for folder in (Path("/usr/lib"), Path("/usr/lib64"), Path("/usr/local/lib")):
        for path in (*folder.glob("libLLVM*.so*"), *folder.glob("*-linux-gnu/libLLVM*.so*")):
            if version := re.search(r"(\d+(?:\.\d+)?)", path.name):
                found.setdefault(float(version[1]), path)
    return found[max(found)] if found else None


def environment(peer: str) -> dict[str, str]:
    """Environment of a driver: ours, for a peer without the Python settings of ours and with LLVM named.

    Python may keep its compiled modules, as it does for users: without them each start compiles them anew.
    """
    ours = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    if peer == "accuray":
        return ours
    variables = {name: value for name, value in ours.items() if name not in ("PYTHONPATH", "VIRTUAL_ENV")}
    if llvm := find_llvm():
        variables[LLVM_VARIABLE] = str(llvm)
    return variables


def command(peer: str, job: dict[str, Any], folder: Path) -> list[str]:
    """Write ``job`` into ``folder`` and return the command line that runs it."""
    with tempfile.NamedTemporaryFile("w", suffix=".json", dir=folder, delete=False) as file:
        json.dump(job, file)
    return [str(python_of(peer)), str(DRIVERS / f"{peer}_driver.py"), file.name]


def run_job(contender: Contender, job: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Run a driver to its end and return its answer, or ``{"error": last lines}``; see ``drivers/common.py``."""
    if reason := missing(contender.peer):
        return {"error": reason}
    job = job | {"variant": contender.variant, "sampler": contender.sampler}
    folder.mkdir(parents=True, exist_ok=True)
    line, variables = command(contender.peer, job, folder), environment(contender.peer)
    finished = subprocess.run(line, env=variables, capture_output=True, text=True, check=False)
    lines = finished.stdout.splitlines()
    if finished.returncode != 0 or not lines:
        return {"error": "\n".join(finished.stderr.splitlines()[-5:]) or f"exit code {finished.returncode}"}
    answer: dict[str, Any] = json.loads(lines[-1])
    return answer
