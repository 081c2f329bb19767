from __future__ import annotations

import os

import pytest

from nispcodec.catalogue.record import CRASH, DONE, INPUT, Record, failed, parsed


def test_a_line_brings_the_record_back() -> None:
    record = Record(
        "in/a.obj",
        os.fsdecode(b"caf\xe9.nisp"),
        DONE,
        inputs={"a.obj": "1", "b.png": None},
        bytes={"total": 5, "input_mesh": 20, "input_textures": 3},
        errors={"distance_error": 1e-3},
        warnings=("one", "two"),
    )
    assert parsed(record.line()) == record
    assert record.line().isascii()
    assert record.saved == 18
    assert parsed(record.line()[:-1] + ', "of a later version": 1}') == record


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ('{"source": "a"', "expected JSON"),
        ("[" * 100_000, "expected JSON"),
        ("3", "expected an object"),
        ('{"source": "a", "output": "b"}', "expected status"),
        ('{"source": 1, "output": "b", "status": "done"}', "source: expected"),
        ('{"source": "a", "output": "b", "status": "done", "bytes": 3}', "bytes: expected"),
    ],
)
def test_what_is_no_record_is_refused(line: str, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        parsed(line)


def test_what_could_not_become_an_asset_has_a_line_too() -> None:
    record = failed("gone", "", INPUT, "none")
    assert parsed(record.line()) == record


def test_a_crash_may_not_come_again_and_a_bad_input_does() -> None:
    assert failed("a", "b", CRASH, "").transient
    assert not failed("a", "b", INPUT, "").transient
