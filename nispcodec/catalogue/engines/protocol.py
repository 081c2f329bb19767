"""An engine: where jobs are done, so many at a time."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

from nispcodec.catalogue.job import Job, Result


class Engine(Protocol):
    """Does jobs side by side. Whatever a job does to its process, the others go on."""

    @property
    def cores(self) -> int:
        """How many cores there are for jobs."""
        ...

    def begin(self, job: Job) -> None:
        """Do a job; `threads` of it say how many of the cores it takes."""
        ...

    def ended(self, seconds: float) -> Iterator[tuple[Job, Result]]:
        """The jobs that have ended; waits for one, but for no longer than some seconds."""
        ...

    def close(self) -> None:
        """Stop whatever is at work. Nothing is half written."""
        ...
