"""A whole batch: plan, lock, ledger, engine, driver, page, from first to last."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from pathlib import Path

from nispcodec.catalogue.config import BatchConfig
from nispcodec.catalogue.engines.protocol import Engine
from nispcodec.catalogue.job import Encoder, Job, Result
from nispcodec.catalogue.ledger import (
    Ledger,
    LocalLedger,
    Records,
    RemoteLedger,
    ledger_name,
    read_ledger,
)
from nispcodec.catalogue.lock import locked
from nispcodec.catalogue.page import write_page
from nispcodec.catalogue.plan import Asset, Problem, Shard, told_apart
from nispcodec.catalogue.record import INPUT, failed
from nispcodec.catalogue.run import Driver, Listener
from nispcodec.catalogue.settings import Settings
from nispcodec.catalogue.storage import full_disk, is_remote, joined, storage_of
from nispcodec.catalogue.work import encoder
from nispcodec.core.errors import NispError
from nispcodec.core.extras import require

# What writing leaves behind where its process was killed: see `write_atomic`.
TEMPORARY = re.compile(r"\.(.+\.(nisp|webp)|catalogue.*\.(jsonl|html))\.[a-z0-9_]{8}")


@dataclass
class Batch:
    """A batch into one folder; see `run`.

    folder    of the catalogue: a path, or a URL for fsspec
    settings  how each asset is encoded, but for what a manifest says of it
    config    how the batch is run
    shard     the part of the assets that is done here
    viewer    URL of a page that shows a `.nisp`, which gets the file's place after `?file=`
    encode    the encoder, a function of a module
    warnings  what the ledger of an earlier run had wrong, known once the batch runs
    driver    of the run, once it runs
    """

    folder: str
    settings: Settings = field(default_factory=Settings)
    config: BatchConfig = field(default_factory=BatchConfig)
    shard: Shard | None = None
    viewer: str = ""
    encode: Encoder = encoder
    warnings: list[str] = field(default_factory=list)
    driver: Driver | None = None

    def run(
        self,
        found: Sequence[Asset | Problem],
        listen: Listener = lambda tally: None,
        warn: Callable[[str], None] = lambda said: None,
    ) -> Generator[Result, None, None]:
        """Each asset's result as they come, problems first.

        Whatever ends it, what is done is in the ledger, and goes on from there. Raises NispError
        where another driver is at work in the folder, or it cannot be written into.
        """
        self.expect_installed()
        assets, problems = told_apart(list(found))
        assets = [each for each in assets if self.shard is None or self.shard.has(each.output)]
        with ExitStack() as stack:
            if not is_remote(self.folder):
                stack.enter_context(locked(Path(self.folder), self.shard))
            records = self._earlier(warn)
            ledger = self._ledger(records)
            stack.callback(self._finish, ledger, records)
            jobs, refused = self._jobs(assets, records)
            for each in self._problems([*problems, *refused]):
                records[f"source {each.record.source}"] = each.record
                ledger.add(each.record)
                yield each
            self.driver = Driver(jobs, self._engine(), ledger, records, self.config.retries, listen)
            yield from self.driver.results()

    def expect_installed(self) -> None:
        """Raises NispError, before the work, where packages are missing that every asset needs."""
        require("scipy", "igl", "embreex", extra="encode", what_for="encoding")
        if self.config.thumbnail:
            require(
                "scipy", "igl", "embreex", "skimage", extra="render", what_for="drawing thumbnails"
            )

    def _problems(self, problems: Sequence[Problem]) -> Iterator[Result]:
        """Of shards, the first tells them all."""
        if self.shard is None or self.shard.number == 1:
            for each in problems:
                yield Result(failed(each.source, "", INPUT, each.error))

    def _jobs(self, assets: Sequence[Asset], records: Records) -> tuple[list[Job], list[Problem]]:
        """A job for each asset, or what is wrong with what is asked of it."""
        jobs, problems = [], []
        for each in assets:
            try:
                jobs.append(self._job(each, records))
            except NispError as why:
                problems.append(Problem(each.source, str(why)))
        return jobs, problems

    def _job(self, asset: Asset, records: Records) -> Job:
        """Raises NispError for options that exclude those of the batch."""
        joined(self.folder, asset.output)
        return Job(
            replace(asset, source=_anywhere(asset.source)),
            _anywhere(self.folder),
            self.settings.changed(asset.options),
            thumbnail=self.config.thumbnail,
            compare=self.config.compare,
            earlier=records.get(asset.output),
        )

    def _earlier(self, warn: Callable[[str], None]) -> Records:
        """The records of earlier runs; problems are found anew."""
        if not is_remote(self.folder) and self.shard is None:
            remove_temporaries(Path(self.folder))
        storage = storage_of(self.folder)
        records, warnings = read_ledger(storage, self.folder, ledger_name(None))
        if self.shard is not None:
            more, said = read_ledger(storage, self.folder, ledger_name(self.shard))
            records = {
                name: each for name, each in (records | more).items() if self.shard.has(name)
            }
            warnings += said
        for each in warnings:
            warn(each)
        return {name: each for name, each in records.items() if each.output}

    def _ledger(self, records: Records) -> Ledger:
        place = joined(self.folder, ledger_name(self.shard))
        if is_remote(self.folder):
            return RemoteLedger(storage_of(self.folder), place, records)
        return LocalLedger(Path(place), records)

    def _engine(self) -> Engine:
        if self.config.engine == "ray":
            from nispcodec.catalogue.engines.ray import RayTasks

            return RayTasks(self.encode, self.config)
        from nispcodec.catalogue.engines.processes import Processes

        config = self.config
        return Processes(self.encode, config.jobs_here(), config.timeout, config.memory_here())

    def _finish(self, ledger: Ledger, records: Records) -> None:
        """Ledger in order, and the page; on a full disk as much as there is room for."""
        try:
            ledger.close(records)
            if self.shard is None:
                write_page(self.folder, records, self.viewer)
        except (OSError, NispError) as why:
            if not full_disk(why):
                raise
            if self.driver is not None:
                self.driver.stopped = self.driver.stopped or str(why)


def _anywhere(place: str) -> str:
    """The place as processes elsewhere on this machine know it, too."""
    return place if is_remote(place) else os.path.abspath(place)  # noqa: PTH100, not UTF-8


def remove_temporaries(folder: Path) -> None:
    """Remove what drivers and workers that were killed had half written; nobody is at work."""
    for path in folder.rglob(".*"):
        if TEMPORARY.fullmatch(path.name) and path.is_file():
            path.unlink(missing_ok=True)
