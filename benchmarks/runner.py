"""Runs what is not finished yet, point by point, in one process or several."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from functools import lru_cache
from multiprocessing import get_context
from pathlib import Path
from time import monotonic

from benchmarks.codecs import Setting, Unavailable, codec
from benchmarks.point import Record, measured
from benchmarks.source import Source
from benchmarks.store import Store


@dataclass(frozen=True)
class Job:
    """One point to be measured."""

    path: Path
    codec: str
    setting: Setting


@dataclass(frozen=True)
class Finished:
    """A job that ended, and how far the run is."""

    record: Record
    done: int
    total: int
    seconds_left: float


def plan(sources: Iterable[Source], codecs: Iterable[str], quick: bool) -> Iterator[Job | Record]:
    """The jobs of a run, and a record for each codec that cannot run and each bad asset."""
    codecs = list(codecs)
    for source in sources:
        for name in codecs:
            try:
                settings = codec(name).settings(source, quick)
            except (Unavailable, ImportError) as why:
                yield _without(source, name, {"skipped": str(why)})
            except Exception as why:
                yield _without(source, name, {"failure": f"{type(why).__name__}: {why}"})
            else:
                yield from (Job(source.path, name, setting) for setting in settings)


def run(jobs: list[Job], store: Store, workers: int) -> Iterator[Finished]:
    """Measure every job, keep its record in the store, and tell of it as it ends."""
    clock = Clock(jobs, workers)
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        started = {pool.submit(_measure, job): job for job in jobs}
        for done, future in enumerate(as_completed(started), start=1):
            record, data, seconds = future.result()
            store.put(record, data)
            left = clock.left(started[future].codec, seconds)
            yield Finished(record, done, len(jobs), left)


class Clock:
    """How long the rest takes, from how long the finished points of each codec took."""

    def __init__(self, jobs: list[Job], workers: int) -> None:
        self.workers = workers
        self.waiting = [job.codec for job in jobs]
        self.took: dict[str, list[float]] = {}

    def left(self, name: str, seconds: float) -> float:
        """Note a finished point of a codec -> seconds left for the whole run."""
        self.waiting.remove(name)
        self.took.setdefault(name, []).append(seconds)
        every = [each for times in self.took.values() for each in times]
        rest = sum(_mean(self.took.get(waiting, every)) for waiting in self.waiting)
        return rest / self.workers


def _mean(values: list[float]) -> float:
    return sum(values) / len(values)


def _without(source: Source, name: str, why: dict[str, str]) -> Record:
    return {"asset": source.name, "codec": name, "setting": {}, **why}


def _measure(job: Job) -> tuple[Record, bytes, float]:
    started = monotonic()
    record, data = _caught(lambda: measured(_source(job.path), job.codec, job.setting), job)
    return record, data, monotonic() - started


def _caught(work: Callable[[], tuple[Record, bytes]], job: Job) -> tuple[Record, bytes]:
    try:
        return work()
    except Exception as why:
        failure = f"{type(why).__name__}: {why}"
        record = {"asset": job.path.stem, "codec": job.codec, "setting": job.setting}
        return record | {"failure": failure}, b""


@lru_cache(maxsize=1)
def _source(path: Path) -> Source:
    """Jobs come asset by asset, so one asset at a time is enough."""
    return Source(path)
