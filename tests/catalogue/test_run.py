from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from nispcodec.catalogue.job import Job, Result
from nispcodec.catalogue.plan import Asset
from nispcodec.catalogue.record import CRASH, DISK, DONE, INPUT, Record
from nispcodec.catalogue.run import Driver
from nispcodec.catalogue.settings import Settings


class Engine:
    """Ends the job that began first, as told: a kind of failure for each of its tries, or done."""

    def __init__(self, cores: int, fate: dict[str, list[str]]) -> None:
        self.cores, self.fate = cores, fate
        self.begun: list[tuple[str, int, int]] = []
        self.running: list[Job] = []
        self.most = 0
        self.closed = False

    def begin(self, job: Job) -> None:
        self.running.append(job)
        self.begun.append((job.asset.output, job.threads, job.tries))
        self.most = max(self.most, sum(each.threads for each in self.running))

    def ended(self, seconds: float) -> Iterator[tuple[Job, Result]]:
        job = self.running.pop(0)
        kinds = self.fate.get(job.asset.output, [])
        if job.tries <= len(kinds):
            yield job, Result(job.failed(kinds[job.tries - 1], "went wrong"))
        else:
            yield job, Result(Record(job.asset.source, job.asset.output, DONE))

    def close(self) -> None:
        self.closed = True


class Ledger:
    def __init__(self, error: OSError | None = None) -> None:
        self.lines: list[Record] = []
        self.error = error

    def add(self, record: Record) -> None:
        if self.error:
            raise self.error
        self.lines.append(record)

    def close(self, records: dict[str, Record]) -> None:
        pass


def jobs(*sizes: int) -> list[Job]:
    return [
        Job(Asset(f"{number}.obj", str(number), size), "out", Settings())
        for number, size in enumerate(sizes)
    ]


def driver(engine: Engine, given: list[Job], ledger: Ledger | None = None) -> Driver:
    return Driver(given, engine, ledger or Ledger(), {}, retries=1)


def test_large_ones_begin_first_and_the_last_get_all_cores() -> None:
    engine = Engine(4, {})
    results = list(driver(engine, jobs(1, 9, 5, 2, 3)).results())
    assert [each.record.output for each in results] == ["1", "2", "4", "3", "0"]
    assert engine.begun == [("1", 1, 1), ("2", 1, 1), ("4", 1, 1), ("3", 1, 1), ("0", 1, 1)]
    assert engine.most <= 4
    engine = Engine(4, {})
    list(driver(engine, jobs(1, 2)).results())
    assert [threads for _, threads, _ in engine.begun] == [2, 2]


def test_what_may_be_done_already_is_asked_first() -> None:
    first, second = jobs(1, 9)
    first = replace(first, earlier=Record("0.obj", "0", DONE))
    engine = Engine(1, {})
    list(driver(engine, [second, first]).results())
    assert [output for output, _, _ in engine.begun] == ["0", "1"]


def test_a_crash_is_tried_again_and_a_bad_input_is_not() -> None:
    engine = Engine(1, {"0": [CRASH], "1": [CRASH, CRASH], "2": [INPUT]})
    ledger = Ledger()
    found = driver(engine, jobs(3, 2, 1, 0), ledger)
    kinds = {each.record.output: (each.record.kind, each.record.tries) for each in found.results()}
    assert kinds == {"0": ("", 2), "1": (CRASH, 2), "2": (INPUT, 1), "3": ("", 1)}
    assert len(ledger.lines) == 4
    tally = found.tally
    assert (tally.done, tally.failed, tally.retried, tally.running) == (2, 2, 2, 0)


def test_a_full_disk_begins_nothing_new() -> None:
    engine = Engine(2, {"1": [DISK]})
    found = driver(engine, jobs(9, 8, 7, 6, 5))
    results = {each.record.output: each.record.status for each in found.results()}
    assert results == {"0": "done", "1": "failed", "2": "done"}
    assert found.stopped == "went wrong"
    assert found.tally.left == 2
    assert engine.closed


@pytest.mark.parametrize("number", [28, 5])
def test_a_ledger_that_cannot_be_written_ends_it(number: int) -> None:
    engine = Engine(1, {})
    found = driver(engine, jobs(2, 1), Ledger(OSError(number, "said the disk")))
    if number == 28:
        assert len(list(found.results())) == 1
        assert "said the disk" in found.stopped
    else:
        with pytest.raises(OSError, match="said the disk"):
            list(found.results())
    assert engine.closed


def test_who_stops_listening_stops_the_work(tmp_path: Path) -> None:
    engine = Engine(1, {})
    results = iter(driver(engine, jobs(2, 1)).results())
    next(results)
    results.close()  # type: ignore[attr-defined]
    assert engine.closed
    assert len(engine.begun) == 1
