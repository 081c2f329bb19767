"""Cores: which of several fits computes when, and with how many threads."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager

Core = Callable[[], AbstractContextManager[int]]
"""Entered for as long as a fit computes: gives how many threads it may use."""


class Stopped(Exception):
    """Nobody wants the result any more."""


class Cores:
    """So many cores for so many fits.

    The first fit, which should be the longest, has a core to itself; the others share what is left,
    and its core too when it is done. What nobody else needs is the first one's as well.
    """

    def __init__(self, cores: int, fits: int) -> None:
        self._cores = cores
        self._running = set(range(fits))
        self._shared = threading.Semaphore(max(1, cores - 1))
        self._stopped = threading.Event()

    def of(self, number: int) -> Core:
        """The core of a fit, by its place among all."""
        alone = number == 0 and self._cores > 1

        @contextmanager
        def held() -> Iterator[int]:
            if alone:
                self._check()
                yield max(1, self._cores - len(self._running) + 1)
                return
            with self._shared:
                self._check()
                yield 1

        return held

    def done(self, number: int) -> None:
        """A fit is done: its core is free."""
        self._running.discard(number)
        if number == 0 and self._cores > 1:
            self._shared.release()

    def stop(self) -> None:
        """Every fit ends with `Stopped` when it next asks for its core."""
        self._stopped.set()

    def _check(self) -> None:
        if self._stopped.is_set():
            raise Stopped


def one_core() -> AbstractContextManager[int]:
    """That of a fit which is alone."""
    return Cores(1, 1).of(0)()
