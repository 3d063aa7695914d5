"""The default number of threads follows the CPU limits of control groups, in both of their versions."""

from __future__ import annotations

from pathlib import Path

import pytest

from accuray.cli.threads import control_group_quota, usable_cpus


def machine(root: Path, groups: str, files: dict[str, str]) -> Path:
    """A file system with /proc/self/cgroup and some files below /sys/fs/cgroup."""
    for name, text in {"proc/self/cgroup": groups, **{f"sys/fs/cgroup/{k}": v for k, v in files.items()}}.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    return root


@pytest.mark.parametrize(
    ("groups", "files", "quota"),
    [
        ("0::/\n", {"cpu.max": "150000 100000\n"}, 1.5),
        ("0::/\n", {"cpu.max": "max 100000\n"}, None),
        ("0::/\n", {}, None),
        ("0::/a/b\n", {"a/b/cpu.max": "max 100000\n", "a/cpu.max": "400000 100000\n"}, 4.0),
        ("0::/a/b\n", {"a/b/cpu.max": "200000 100000\n", "a/cpu.max": "400000 100000\n"}, 2.0),
        (
            "5:cpu,cpuacct:/job\n3:memory:/job\n",
            {"cpu/job/cpu.cfs_quota_us": "300000\n", "cpu/job/cpu.cfs_period_us": "100000\n"},
            3.0,
        ),
        ("5:cpu:/\n", {"cpu/cpu.cfs_quota_us": "-1\n", "cpu/cpu.cfs_period_us": "100000\n"}, None),
    ],
)
def test_quota(tmp_path: Path, groups: str, files: dict[str, str], quota: float | None) -> None:
    assert control_group_quota(machine(tmp_path, groups, files)) == quota


def test_machine_without_control_groups(tmp_path: Path) -> None:
    assert control_group_quota(tmp_path) is None
    assert usable_cpus(tmp_path) >= 1


def test_tiny_quota_still_gives_a_thread(tmp_path: Path) -> None:
    assert usable_cpus(machine(tmp_path, "0::/\n", {"cpu.max": "10000 100000\n"})) == 1


def test_quota_above_the_processors_changes_nothing(tmp_path: Path) -> None:
    wide = machine(tmp_path / "wide", "0::/\n", {"cpu.max": "100000000 100000\n"})
    assert usable_cpus(wide) == usable_cpus(tmp_path / "none")
