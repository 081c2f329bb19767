"""Run a command and measure its wall time and the peak memory of its whole process tree."""

from __future__ import annotations

import resource
import subprocess
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

INTERVAL = 0.2


@dataclass(frozen=True)
class Run:
    """What a finished command took. `peak_bytes` is the largest sampled sum of PSS.

    Where `cpu_seconds` is much less than `seconds` times the threads, others used the machine.
    """

    seconds: float
    cpu_seconds: float
    peak_bytes: int
    stdout: str


def run(
    command: Sequence[str | Path], scratch: Path, environment: Mapping[str, str] | None = None
) -> Run:
    """Run to the end; raises RuntimeError with the last words of stderr when it fails.

    `scratch` is a folder for the output of the command, which could fill a pipe; `environment` is
    what the command sees in place of our own.
    """
    out, err = scratch / "stdout", scratch / "stderr"
    started, cpu, peak = time.monotonic(), _children_seconds(), 0
    with out.open("wb") as stdout, err.open("wb") as stderr:
        words = list(map(str, command))
        process = subprocess.Popen(words, stdout=stdout, stderr=stderr, env=environment)
        while not _ends_within(process, INTERVAL):
            peak = max(peak, sum(map(proportional_bytes, family(process.pid))))
    seconds = time.monotonic() - started
    if process.returncode != 0:
        last = err.read_text(errors="replace")[-800:]
        raise RuntimeError(f"{' '.join(map(str, command))}: exit {process.returncode}: {last}")
    return Run(round(seconds, 2), round(_children_seconds() - cpu, 2), peak, out.read_text())


def _ends_within(process: subprocess.Popen[bytes], seconds: float) -> bool:
    """Whether it does; told as soon as it ends, so that times are not whole intervals."""
    try:
        process.wait(seconds)
    except subprocess.TimeoutExpired:
        return False
    return True


def _children_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def family(pid: int) -> list[int]:
    """The process and all its descendants, as far as they still run."""
    try:
        lists = [each.read_text() for each in Path(f"/proc/{pid}/task").glob("*/children")]
    except OSError:
        return []
    children = [int(child) for text in lists for child in text.split()]
    return [pid, *(each for child in children for each in family(child))]


def proportional_bytes(pid: int) -> int:
    """Memory of a process where pages shared by n processes count 1/n; 0 when it is gone."""
    try:
        text = Path(f"/proc/{pid}/smaps_rollup").read_text()
    except OSError:
        return 0
    sizes = [int(line.split()[1]) for line in text.splitlines() if line.startswith("Pss:")]
    return 1024 * sum(sizes)
