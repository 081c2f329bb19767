from __future__ import annotations

import re
import time

from nispcodec.catalogue.job import Result
from nispcodec.catalogue.record import DONE, Record, failed
from nispcodec.catalogue.tally import METRICS, Tally, open_metrics

RECORD = Record("a", "b", DONE, bytes={"total": 10, "input_mesh": 70, "input_textures": 5})


def test_pace_and_time_left_are_of_what_was_encoded_not_kept() -> None:
    tally = Tally(10, began=time.monotonic() - 3600)
    assert "seconds_left" not in tally.facts
    for result in (Result(RECORD), Result(RECORD, kept=True), Result(failed("a", "b", "bug", ""))):
        tally.hear(result)
    assert (tally.done, tally.kept, tally.failed, tally.left) == (1, 1, 1, 7)
    assert abs(tally.hourly - 2) < 0.01
    assert abs(tally.seconds_left - 3.5 * 3600) < 20
    assert tally.facts["saved_bytes"] == 130


def test_metrics_are_open_metrics_text() -> None:
    tally = Tally(3)
    tally.hear(Result(RECORD))
    text = open_metrics(tally)
    assert text.endswith("# EOF\n")
    assert "\nnisp_batch_assets_done_total 1\n" in text
    assert "\nnisp_batch_assets 3\n" in text
    for line in text.splitlines()[:-1]:
        assert re.fullmatch(r"# (TYPE|HELP) nisp_batch_\w+ .+|nisp_batch_\w+ [\d.]+", line)
    assert text.count("# TYPE") == len(METRICS)
