from __future__ import annotations

import time
from math import inf

import pytest
from nispcodec_cli.batch_progress import Reporter, printable, progress_line, size

from nispcodec.catalogue.tally import Tally


@pytest.mark.parametrize(
    ("count", "said"),
    [(0, "0 B"), (999, "999 B"), (4.1e6, "4.1 MB"), (-2500, "-2.5 kB"), (5e15, "5000.0 TB")],
)
def test_sizes_have_units(count: float, said: str) -> None:
    assert size(count) == said


def test_a_line_says_pace_time_left_and_bytes_saved() -> None:
    tally = Tally(64, done=12, failed=1, running=2, in_bytes=5_000_000, out_bytes=900_000)
    tally.began = time.monotonic() - 150
    expected = (
        "12 of 64 done, 1 failed, 2 running, 312 an hour, about 9 min 48 s left, 4.1 MB saved"
    )
    assert progress_line(tally) == expected
    assert progress_line(Tally(3)) == "0 of 3 done, 0 running, 0 B saved"


def test_names_that_are_no_utf8_can_be_printed() -> None:
    assert printable("caf\udce9") == r"caf\udce9"


def test_a_terminal_has_one_line_that_is_rewritten(capsys: pytest.CaptureFixture[str]) -> None:
    reporter = Reporter(0, rewrite=True, as_json=False, metrics=None)
    reporter.tick(Tally(3))
    reporter.tick(Tally(3, done=1))
    reporter.warn("odd")
    said = capsys.readouterr().err
    assert said.count("\r\x1b[K") == 2
    assert said.endswith("nisp: warning: odd\n")


def test_quiet_says_nothing_of_the_way(capsys: pytest.CaptureFixture[str]) -> None:
    Reporter(inf, rewrite=False, as_json=False, metrics=None).tick(Tally(3))
    assert capsys.readouterr().err == ""
