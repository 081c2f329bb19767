"""Work on every core: threads, as numpy lets others run while it computes."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, nullcontext
from functools import cache
from threading import Lock, local
from typing import TypeVar

from threadpoolctl import ThreadpoolController

from nispcodec.core.cores import at_most, cores

Part = TypeVar("Part")

_ALONE = Lock()
_mine = local()


def parallel_for(run: Callable[[Part], object], parts: Sequence[Part]) -> None:
    """Run on each of the parts, on as many threads as there are cores.

    A part that does the same with parts of its own has one core for them. An error, or Ctrl-C, ends
    the work: it is raised when all threads are done with the part that they are at.
    """
    workers = min(cores(), len(parts))
    if workers < 2 or getattr(_mine, "busy", False):
        for part in parts:
            run(part)
        return
    waiting = iter(parts)

    def work() -> None:
        _mine.busy = True
        for part in waiting:
            run(part)

    # One BLAS thread a worker: BLAS's own threads would fight with ours for the same cores. The
    # limit is the whole process's, so that two callers at once would undo it for each other.
    with _ALONE, _blas().limit(limits=1, user_api="blas"), ThreadPoolExecutor(workers) as pool:
        try:
            for done in [pool.submit(work) for _ in range(workers)]:
                done.result()
        finally:
            deque(waiting, maxlen=0)


@contextmanager
def on_cores(count: int) -> Iterator[None]:
    """In this block what this process computes uses so many cores; 0: all of them."""
    limits = nullcontext() if count == 0 else ThreadpoolController().limit(limits=count)
    with at_most(count), limits:
        yield


@cache
def _blas() -> ThreadpoolController:
    """The loaded BLAS libraries; looking for them takes milliseconds: once a process."""
    return ThreadpoolController()
