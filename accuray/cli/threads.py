"""How many threads to render with: the flag, else the environment, else what this machine lets us use."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

from .parser import UsageError

# In this order; the second is what a batch system sets for the job that we run in.
VARIABLES = ("ACCURAY_THREADS", "SLURM_CPUS_PER_TASK")


def thread_count(flag: int | None, environment: Mapping[str, str] = os.environ) -> int:
    """The number of threads, at least 1.

    Raises:
        UsageError: a variable that counts is set to something else than a whole number of at least 1.
    """
    if flag is not None:
        return flag
    for name in VARIABLES:
        text = environment.get(name, "").strip()
        if text:
            if not text.isdecimal() or int(text) < 1:
                raise UsageError(f"{name} is {text!r}, but must be a whole number of at least 1", "accuray render")
            return int(text)
    return usable_cpus()


def usable_cpus(root: Path = Path("/")) -> int:
    """CPUs that this process may run on, cut to the CPU time that its control group is allowed."""
    cpus = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    quota = control_group_quota(root)
    return cpus if quota is None else max(1, min(cpus, round(quota)))


def control_group_quota(root: Path = Path("/")) -> float | None:
    """CPUs' worth of time that the control groups around this process grant; None without a limit or without groups.

    Both versions of Linux control groups; a limit on any group around ours counts, so the smallest one is taken.
    """
    try:
        groups = (root / "proc/self/cgroup").read_text().splitlines()
    except OSError:
        return None
    quotas: list[float] = []
    for line in groups:
        _, controllers, path = line.split(":", 2)
        if controllers and "cpu" not in controllers.split(","):
            continue
        mount = root / "sys/fs/cgroup" / ("cpu" if controllers else "")
        here = mount / path.lstrip("/")
        for folder in (here, *here.parents):
            quotas.extend(_quota(folder))
            if folder == mount:
                break
    return min(quotas, default=None)


def _quota(folder: Path) -> list[float]:
    """The limit of one control group in CPUs, or nothing."""
    try:
        if (folder / "cpu.max").exists():
            allowed, period = (folder / "cpu.max").read_text().split()
        else:
            allowed = (folder / "cpu.cfs_quota_us").read_text().strip()
            period = (folder / "cpu.cfs_period_us").read_text().strip()
        return [int(allowed) / int(period)] if int(allowed) > 0 else []
    except (OSError, ValueError):  # no such file, or "max": no limit here
        return []
