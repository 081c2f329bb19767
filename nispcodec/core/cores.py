"""How many cores the work of this process may use."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

# What `at_most` says now, 0 for nothing: the process's, as limits of BLAS are.
_limits: list[int] = [0]


def cores() -> int:
    """As many as the system lets this process use, or fewer, as `at_most` says."""
    if hasattr(os, "sched_getaffinity"):
        there = len(os.sched_getaffinity(0))
    else:
        there = os.cpu_count() or 1
    return min(there, _limits[-1] or there)


@contextmanager
def at_most(count: int) -> Iterator[None]:
    """In this block `cores` gives no more than `count`; 0: as many as before."""
    _limits.append(count or _limits[-1])
    try:
        yield
    finally:
        _limits.pop()
