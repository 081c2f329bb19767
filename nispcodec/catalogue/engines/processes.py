"""The engine of one machine: a process for each job at work, kept for the next one."""

from __future__ import annotations

import time
from collections.abc import Iterator
from multiprocessing.connection import wait

from nispcodec.catalogue.engines.child import Child, ruined
from nispcodec.catalogue.job import Encoder, Job, Result
from nispcodec.catalogue.record import CRASH


class Processes:
    """Children of this process.

    cores    how many jobs of one thread are done at a time
    timeout  seconds that a job may take, 0 for any number
    memory   bytes that the process of a job may allocate, 0 for any number
    """

    def __init__(self, encode: Encoder, cores: int, timeout: float = 0, memory: int = 0) -> None:
        self._encode, self._cores = encode, cores
        self._timeout, self._memory = timeout, memory
        self._idle: list[Child] = []
        self._busy: list[Child] = []

    @property
    def cores(self) -> int:
        """How many jobs of one thread are done at a time."""
        return self._cores

    def begin(self, job: Job) -> None:
        """Give the job to a child that is idle, or to a new one."""
        for child in [each for each in self._idle if not each.alive]:
            self._idle.remove(child)
            child.close()
        child = self._idle.pop() if self._idle else Child(self._encode, self._memory)
        self._busy.append(child)
        child.begin(job)

    def ended(self, seconds: float) -> Iterator[tuple[Job, Result]]:
        """The jobs that have ended, or took too long."""
        ready = wait([child.connection for child in self._busy], self._patience(seconds))
        for child in [each for each in self._busy if each.connection in ready]:
            yield self._ended(child)
        for child in [each for each in self._busy if self._late(each)]:
            self._busy.remove(child)
            assert child.job is not None
            yield child.job, child.timed_out(self._timeout)

    def close(self) -> None:
        """Kill all children."""
        for child in (*self._idle, *self._busy):
            child.close()
        self._idle, self._busy = [], []

    def _ended(self, child: Child) -> tuple[Job, Result]:
        job = child.job
        assert job is not None
        result = child.result()
        self._busy.remove(child)
        if result.record.kind == CRASH or ruined(result):
            child.close()
        else:
            self._idle.append(child)
        return job, result

    def _late(self, child: Child) -> bool:
        return bool(self._timeout) and time.monotonic() - child.began > self._timeout

    def _patience(self, seconds: float) -> float:
        """No longer than until the next job is late."""
        if not self._timeout or not self._busy:
            return seconds
        oldest = min(child.began for child in self._busy)
        return min(seconds, max(0.0, oldest + self._timeout - time.monotonic()) + 0.01)
