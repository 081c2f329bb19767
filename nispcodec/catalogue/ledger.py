"""The ledger of a catalogue, `catalogue.jsonl`: a line for each asset, written as they are done."""

from __future__ import annotations

import os
import re
import time
from collections.abc import Iterable
from pathlib import Path
from typing import BinaryIO, Protocol

from nispcodec.catalogue.plan import Shard
from nispcodec.catalogue.record import Record, parsed
from nispcodec.catalogue.storage import Storage, joined
from nispcodec.core.atomic_write import write_atomic
from nispcodec.core.errors import NispError

NAME = "catalogue"
SHARDS = re.compile(r"catalogue-(\d+)-of-(\d+)\.jsonl")

Records = dict[str, Record]
"""By output; what could not become an asset has none and goes by its source."""


class Ledger(Protocol):
    """Keeps records, however the driver ends."""

    def add(self, record: Record) -> None:
        """Keep another one. Raises OSError or NispError where it cannot be written."""
        ...

    def close(self, records: Records) -> None:
        """Write all of them anew, a line each. Raises OSError or NispError likewise."""
        ...


def ledger_name(shard: Shard | None) -> str:
    """`catalogue.jsonl`, or that of a shard."""
    return f"{NAME}{shard.suffix if shard else ''}.jsonl"


def key(record: Record) -> str:
    """The name that a record goes by: another one of the same key takes its place."""
    return record.output or f"source {record.source}"


def read_ledger(storage: Storage, folder: str, name: str) -> tuple[Records, list[str]]:
    """The records in a ledger, none where there is none, and a warning for each line that is none.

    The last of several lines of one asset counts.
    """
    place = joined(folder, name)
    try:
        data = storage.read(place)
    except FileNotFoundError:
        return {}, []
    records: Records = {}
    warnings = []
    for number, line in enumerate(data.decode("utf-8", "replace").split("\n"), 1):
        if not line.strip("\0 \r"):
            continue
        try:
            record = parsed(line)
            records[key(record)] = record
        except ValueError as why:
            warnings.append(f"{place} line {number}: {why}; its asset is done again")
    return records, warnings


def ledger_bytes(records: Iterable[Record]) -> bytes:
    """The lines of some records, in order of their outputs."""
    return "".join(f"{each.line()}\n" for each in sorted(records, key=key)).encode()


class LocalLedger:
    """A file that lines are appended to, each at once: what is there stays if the driver is killed.

    Begins with the records that it is given, one line each.
    """

    def __init__(self, path: Path, records: Records) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        self._path = path
        write_atomic(path, ledger_bytes(records.values()))
        self._file: BinaryIO = path.open("ab", buffering=0)

    def add(self, record: Record) -> None:
        """Append its line; half a line is taken back. Raises OSError for a full disk."""
        line, size = f"{record.line()}\n".encode(), os.fstat(self._file.fileno()).st_size
        try:
            written = self._file.write(line)
        except OSError:
            written = 0
        if written != len(line):
            self._file.truncate(size)
            raise OSError(28, "No space left on device", str(self._path))

    def close(self, records: Records) -> None:
        """Write one line an asset, in order, in the file's place."""
        self._file.close()
        write_atomic(self._path, ledger_bytes(records.values()))


class RemoteLedger:
    """An object that is written anew from time to time, as nothing can be appended to objects.

    least: seconds between two; share: of the time that writing may take. What a killed driver had
    not written yet is done again.
    """

    def __init__(
        self, storage: Storage, place: str, records: Records, least: float = 30, share: float = 0.05
    ) -> None:
        self._storage, self._place, self._records = storage, place, dict(records)
        self._least, self._share = least, share
        self._write()

    def add(self, record: Record) -> None:
        """Keep it, and write all if it is time. Raises what the storage raises."""
        self._records[key(record)] = record
        if time.monotonic() >= self._next:
            self._write()

    def close(self, records: Records) -> None:
        """Write all."""
        self._records = dict(records)
        self._write()

    def _write(self) -> None:
        started = time.monotonic()
        self._storage.write(self._place, ledger_bytes(self._records.values()))
        took = time.monotonic() - started
        self._next = time.monotonic() + max(self._least, took / self._share)


def merge(folder: Path) -> tuple[Records, list[str]]:
    """Join the ledgers of all shards into `catalogue.jsonl` -> its records, and warnings.

    The ledgers of the shards are removed. Raises NispError where there is none, or where shards
    are of different counts.
    """
    from nispcodec.catalogue.storage import Local

    found = {path: SHARDS.fullmatch(path.name) for path in sorted(folder.glob(f"{NAME}-*.jsonl"))}
    parts = {path: Shard(int(each[1]), int(each[2])) for path, each in found.items() if each}
    counts = {shard.count for shard in parts.values()}
    if len(counts) != 1:
        said = f"shards of {len(counts)} counts" if counts else "none"
        raise NispError(f"{folder}: expected {NAME}-1-of-N.jsonl to -N-of-N.jsonl, found {said}")
    records, warnings = read_ledger(Local(), str(folder), ledger_name(None))
    for path in parts:
        more, said_of_it = read_ledger(Local(), str(folder), path.name)
        records |= more
        warnings += said_of_it
    absent = set(range(1, counts.pop() + 1)) - {shard.number for shard in parts.values()}
    if absent:
        warnings.append(f"{folder}: no ledger of shards {', '.join(map(str, sorted(absent)))}")
    write_atomic(folder / ledger_name(None), ledger_bytes(records.values()))
    for path in parts:
        path.unlink()
    return records, warnings
