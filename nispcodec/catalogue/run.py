"""The driver: hands jobs to an engine, tries again, and keeps the ledger."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from nispcodec.catalogue.engines.protocol import Engine
from nispcodec.catalogue.job import Job, Result
from nispcodec.catalogue.ledger import Ledger, Records, key
from nispcodec.catalogue.record import DISK
from nispcodec.catalogue.storage import full_disk
from nispcodec.catalogue.tally import Tally
from nispcodec.core.errors import NispError

Listener = Callable[[Tally], None]
TICK = 1.0
"""Seconds after which listeners are told the time, if nothing else."""


class Driver:
    """Runs jobs to their ends on an engine, with a ledger.

    jobs      in any order
    records   what is known so far, by output; kept up to date
    retries   after failures that may not come again
    listen    hears of every change, and every second
    """

    def __init__(
        self,
        jobs: Sequence[Job],
        engine: Engine,
        ledger: Ledger,
        records: Records,
        retries: int,
        listen: Listener = lambda tally: None,
    ) -> None:
        self.tally = Tally(len(jobs))
        self.stopped = ""
        self._waiting = deque(sorted(jobs, key=_order))
        self._engine, self._ledger, self._records = engine, ledger, records
        self._retries, self._listen = retries, listen
        self._threads = 0

    def results(self) -> Iterator[Result]:
        """Each asset's result, as they come. A full disk ends it early: `stopped` says so.

        Whoever stops listening stops the engine; so does an exception. Raises NispError where the
        ledger cannot be written for another reason.
        """
        try:
            while self._waiting or self.tally.running:
                self._begin()
                for job, result in self._engine.ended(TICK):
                    self.tally.running -= 1
                    self._threads -= job.threads
                    if self._again(job, result):
                        continue
                    yield self._kept(result, job)
                self._listen(self.tally)
        finally:
            self._engine.close()

    def _begin(self) -> None:
        """Begin as many as there are cores for; the last ones get the cores of those that ended."""
        while self._waiting and self._threads < self._engine.cores:
            left = len(self._waiting) + self.tally.running
            threads = max(1, self._engine.cores // left)
            job = replace(self._waiting.popleft(), threads=threads)
            self._engine.begin(job)
            self.tally.running += 1
            self._threads += threads

    def _again(self, job: Job, result: Result) -> bool:
        """Put a job back that failed in a way that may not come again."""
        if not result.record.transient or job.tries > self._retries or self.stopped:
            return False
        self._waiting.append(replace(job, tries=job.tries + 1))
        self.tally.retried += 1
        return True

    def _kept(self, result: Result, job: Job) -> Result:
        """The result, counted and written down."""
        if not result.kept:
            result = replace(result, record=replace(result.record, tries=job.tries))
        self.tally.hear(result)
        self._records[key(result.record)] = result.record
        try:
            if not result.kept:
                self._ledger.add(result.record)
        except (OSError, NispError) as why:
            if not full_disk(why):
                raise
            self._stop(str(why))
        if result.record.kind == DISK:
            self._stop(result.record.error)
        return result

    def _stop(self, why: str) -> None:
        self.stopped = why
        self._waiting.clear()


def _order(job: Job) -> tuple[bool, int, str]:
    """What may be done already first, as that is soon told; then the largest."""
    return job.earlier is None or not job.earlier.done, -job.asset.size, job.asset.output
