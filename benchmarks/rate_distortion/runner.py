"""Runs what is not finished yet, point by point, in one process or several."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass, replace
from functools import lru_cache
from multiprocessing import get_context
from pathlib import Path
from time import monotonic

from benchmarks.assets.source import Source
from benchmarks.codecs import Setting, Unavailable, codec
from benchmarks.measuring.result_file import Record
from benchmarks.rate_distortion import drawing, point, textures
from benchmarks.rate_distortion.hull import lower_hull
from benchmarks.rate_distortion.rows import pairs, row
from benchmarks.rate_distortion.store import Store
from benchmarks.rate_distortion.textures import TEXTURES

# Codecs whose decodes are worth looking at; text and floats look like the original.
DRAWN = ("nisp", "nisp_paper", "simplified_draco", "draco", "gltfpack")


@dataclass(frozen=True)
class Job:
    """One point to be measured, or, when it is, to be drawn."""

    path: Path
    codec: str
    setting: Setting
    draw: bool = False

    def done(self, store: Store) -> bool:
        """Whether the store has the result already; a failure is none."""
        record = store.find(self.path.stem, self.codec, self.setting)
        if record is None or "failure" in record:
            return False
        return not self.draw or "psnr" in record.get("pictures", {})


@dataclass(frozen=True)
class Finished:
    """A job that ended, and how far the run is."""

    record: Record
    done: int
    total: int
    seconds_left: float


def plan(source: Source, codecs: Sequence[str], quick: bool) -> Iterator[Job | Record]:
    """The points of one asset, and a record for each codec that cannot run on it."""
    for name in codecs:
        try:
            settings = _settings(source, name, quick)
        except (Unavailable, ImportError) as why:
            yield _without(source, name, {"skipped": str(why)})
        except Exception as why:
            yield _without(source, name, {"failure": f"{type(why).__name__}: {why}"})
        else:
            yield from (Job(source.path, name, setting) for setting in settings)


def drawings(measured: Sequence[Job], store: Store) -> Iterator[Job]:
    """Of finished points those to be drawn: ours, and the lower hull of each peer."""
    curves: dict[tuple[Path, str], list[tuple[Job, Record]]] = {}
    for job in measured:
        record = store.find(job.path.stem, job.codec, job.setting)
        if job.codec in DRAWN and record is not None and "metrics" in record:
            curves.setdefault((job.path, job.codec), []).append((job, record))
    for (_, name), points in curves.items():
        sizes = pairs([row(record) for _, record in points], "distance")
        chosen = range(len(points)) if name == "nisp" else lower_hull(sizes)
        yield from (replace(points[index][0], draw=True) for index in chosen)


def run(jobs: Sequence[Job], store: Store, workers: int) -> Iterator[Finished]:
    """Do every job; its record is in the store when it is told of."""
    clock = Clock(jobs, workers)
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        started = {pool.submit(_work, job, store): job for job in jobs}
        for done, future in enumerate(as_completed(started), start=1):
            record, seconds = future.result()
            left = clock.left(started[future].codec, seconds)
            yield Finished(record, done, len(jobs), left)


class Clock:
    """How long the rest takes, from how long the finished points of each codec took."""

    def __init__(self, jobs: Sequence[Job], workers: int) -> None:
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


def _settings(source: Source, name: str, quick: bool) -> Sequence[Setting]:
    if name == TEXTURES:
        return textures.SETTINGS
    return codec(name).settings(source, quick)


def _mean(values: list[float]) -> float:
    return sum(values) / len(values)


def _without(source: Source, name: str, why: dict[str, str]) -> Record:
    return {"asset": source.name, "codec": name, "setting": {}, **why}


def _work(job: Job, store: Store) -> tuple[Record, float]:
    started = monotonic()
    try:
        record = _drawn(job, store) if job.draw else _measured(job, store)
    except Exception as why:
        record = {"asset": job.path.stem, "codec": job.codec, "setting": job.setting}
        record |= {"failure": f"{type(why).__name__}: {why}"}
        store.put(record)
    return record, monotonic() - started


def _measured(job: Job, store: Store) -> Record:
    source = _gallery(job.path).source
    if job.codec == TEXTURES:
        record, data = textures.measured(source, job.setting)
    else:
        record, data = point.measured(source, job.codec, job.setting)
    store.put(record, data)
    return record


def _drawn(job: Job, store: Store) -> Record:
    record = store.find(job.path.stem, job.codec, job.setting)
    assert record is not None
    gallery = _gallery(job.path)
    record, picture = gallery.drawn(record, store.file(record))
    store.put(record, picture=picture)
    store.put_original(job.path.stem, drawing.as_webp(gallery.original[0]))
    return record


@lru_cache(maxsize=1)
def _gallery(path: Path) -> drawing.Gallery:
    """Jobs come asset by asset, so one asset at a time is enough."""
    return drawing.Gallery(Source(path))
