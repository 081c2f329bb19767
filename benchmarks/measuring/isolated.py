"""Work in a process of its own: a crash ends only that work, and its time and memory are known."""

from __future__ import annotations

import multiprocessing
import resource
import time
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

RESET_PEAK = "5"


@dataclass(frozen=True)
class Cost:
    """What some work took.

    seconds of wall time, and of processor time in all threads; peak_bytes: what the work needed
    beyond the memory of its inputs.
    """

    seconds: float
    cpu_seconds: float
    peak_bytes: int


class WorkFailed(Exception):
    """The work raised, or its process died."""


def isolated(work: Callable[[], Any]) -> tuple[Any, Cost]:
    """Do it in a forked process -> (what it returned, its cost). Raises WorkFailed."""
    context = multiprocessing.get_context("fork")
    receiver, sender = context.Pipe(duplex=False)
    process = context.Process(target=_report, args=(work, sender))
    process.start()
    sender.close()
    try:
        answer, failure, cost = receiver.recv()
    except EOFError:
        process.join()
        raise WorkFailed(f"the process ended with code {process.exitcode}") from None
    process.join()
    if failure:
        raise WorkFailed(failure)
    return answer, cost


def _report(work: Callable[[], Any], sender: Connection) -> None:
    Path("/proc/self/clear_refs").write_text(RESET_PEAK)
    before, cpu, started = _status("VmRSS"), _cpu_seconds(), time.perf_counter()
    try:
        answer, failure = work(), ""
    except Exception as why:
        answer, failure = None, f"{type(why).__name__}: {why}"
    seconds, used = time.perf_counter() - started, _cpu_seconds() - cpu
    # Programs started by the work count by the largest of them.
    programs = 1024 * resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
    peak = max(_status("VmHWM") - before, programs)
    sender.send((answer, failure, Cost(round(seconds, 4), round(used, 4), peak)))


def _cpu_seconds() -> float:
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(each.ru_utime + each.ru_stime for each in used)


def _status(name: str) -> int:
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith(f"{name}:")) * 1024
