from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest

from nispcodec.catalogue.ledger import (
    LocalLedger,
    RemoteLedger,
    ledger_name,
    merge,
    read_ledger,
)
from nispcodec.catalogue.plan import Shard
from nispcodec.catalogue.record import DONE, Record, failed
from nispcodec.catalogue.storage import Local
from nispcodec.core.errors import NispError

A, B = Record("a.obj", "a.nisp", DONE), Record("b.obj", "b.nisp", DONE)
NAME = ledger_name(None)


def test_lines_are_there_at_once_and_the_last_one_counts(tmp_path: Path) -> None:
    ledger = LocalLedger(tmp_path / NAME, {"b.nisp": B})
    ledger.add(failed("a.obj", "a.nisp", "crash", "died"))
    ledger.add(A)
    assert len((tmp_path / NAME).read_text().splitlines()) == 3
    records, warnings = read_ledger(Local(), str(tmp_path), NAME)
    assert records == {"a.nisp": A, "b.nisp": B}
    assert not warnings
    ledger.close(records)
    assert (tmp_path / NAME).read_text() == f"{A.line()}\n{B.line()}\n"


def test_half_a_line_costs_its_asset_alone(tmp_path: Path) -> None:
    (tmp_path / NAME).write_bytes(A.line().encode() + b"\n" + B.line().encode()[:20] + b"\n\0\0\n")
    records, warnings = read_ledger(Local(), str(tmp_path), NAME)
    assert records == {"a.nisp": A}
    assert "line 2: expected JSON" in warnings[0]
    assert len(warnings) == 1
    assert read_ledger(Local(), str(tmp_path / "none"), NAME) == ({}, [])


def test_on_a_full_disk_half_a_line_is_taken_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ledger = LocalLedger(tmp_path / NAME, {"a.nisp": A})
    file: Any = ledger._file

    class Full:
        """Writes three bytes, as a disk with room for three does."""

        def write(self, data: bytes) -> int:
            return int(os.write(file.fileno(), data[:3]))

        def fileno(self) -> int:
            return int(file.fileno())

        def truncate(self, size: int) -> None:
            file.truncate(size)

    monkeypatch.setattr(ledger, "_file", Full())
    with pytest.raises(OSError, match="No space left"):
        ledger.add(B)
    assert (tmp_path / NAME).read_text() == f"{A.line()}\n"


def test_elsewhere_all_is_written_when_it_is_time(tmp_path: Path) -> None:
    place = tmp_path / NAME
    lazy = RemoteLedger(Local(), str(place), {}, least=1e6)
    lazy.add(A)
    assert place.read_text() == ""
    lazy.close({"a.nisp": A})
    assert place.read_text() == f"{A.line()}\n"
    RemoteLedger(Local(), str(place), {}, least=0, share=1e9).add(B)
    assert place.read_text() == f"{B.line()}\n"


def test_shards_are_merged_over_what_was_there(tmp_path: Path) -> None:
    LocalLedger(tmp_path / NAME, {"a.nisp": failed("a.obj", "a.nisp", "crash", "")})
    LocalLedger(tmp_path / ledger_name(Shard(1, 3)), {"a.nisp": A})
    LocalLedger(tmp_path / ledger_name(Shard(3, 3)), {"b.nisp": B})
    records, warnings = merge(tmp_path)
    assert records == {"a.nisp": A, "b.nisp": B}
    assert "no ledger of shards 2" in warnings[0]
    assert [each.name for each in tmp_path.iterdir()] == [NAME]
    with pytest.raises(NispError, match=r"found none"):
        merge(tmp_path)


def test_shards_of_several_counts_are_refused(tmp_path: Path) -> None:
    for shard in (Shard(1, 2), Shard(1, 3)):
        LocalLedger(tmp_path / ledger_name(shard), {})
    with pytest.raises(NispError, match="found shards of 2 counts"):
        merge(tmp_path)
