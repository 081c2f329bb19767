from __future__ import annotations

import pytest

from benchmarks.measuring.build import HERE
from benchmarks.report.document import (
    DOCUMENT,
    README,
    commits,
    duel_cells,
    introduced,
    percentage,
    replaced,
    seeds_line,
    size_of,
    written,
)
from benchmarks.report.markdown import columns, table


def test_only_what_stands_between_the_markers_changes() -> None:
    text = "before\n<a>\nold\n<b>\nafter <b>\n"
    assert replaced(text, "<a>\n", "<b>\n", "new\n") == "before\n<a>\nnew\n<b>\nafter <b>\n"


def test_a_line_has_a_dash_where_the_rival_is_never_as_good() -> None:
    sizes = {"distance": 4000, "distance and uv": None, "between settings": None}
    shares = {"distance": 2.375, "distance and uv": None, "between settings": None}
    duel = {"bytes": 9500, "rival_bytes": sizes, "share": shares, "color_above": None}
    assert duel_cells("a", duel) == ["a", "9.5", "4.0", "–", "–", "–", "–"]


def test_a_line_says_what_share_of_the_rival_we_are_and_whose_color_is_better() -> None:
    sizes = {"distance": 19000, "distance and uv": 20000, "between settings": 19000}
    shares = {"distance": 0.5, "distance and uv": 0.48, "between settings": 0.5}
    duel = {"bytes": 9500, "rival_bytes": sizes, "share": shares, "color_above": -1.25}
    assert duel_cells("a", duel) == ["a", "9.5", "19.0", "20.0", "19.0", "0.50", "-1.2"]


def test_the_seeds_and_their_spread_are_said() -> None:
    one, apart = {"count": 1, "share": None}, {"count": 3, "share": [0.5, 0.6]}
    assert seeds_line([{"seeds": one}, {"seeds": apart}]) == "One seed."
    spread = seeds_line([{"seeds": apart}, {"seeds": {"count": 3, "share": None}}])
    assert spread.startswith("Means of 3 seeds;")
    assert "20% above" in spread


def test_other_codecs_are_shown_where_they_are_measured() -> None:
    rows = [{"asset": "a", "codec": "draco", "setting": "11 10", "bytes": "12345"}]
    assert size_of(rows, "a", "Draco 11/10 bits") == 12345
    assert size_of(rows, "b", "Draco 11/10 bits") is None


def test_a_delta_rate_is_a_share_more_or_less_or_a_dash() -> None:
    assert [percentage(share) for share in (-0.284, 0.12, None)] == ["-28%", "+12%", "–"]


def test_a_table_has_a_rule_below_its_head() -> None:
    assert table(["a", "b"], [["1", "2"]]) == "| a | b |\n| --- | --- |\n| 1 | 2 |\n"


def test_columns_are_as_wide_as_their_longest_text() -> None:
    assert columns(["a", "b"], [["long", "1"], ["", ""]]) == "a     b\nlong  1\n\n"


def test_the_document_says_what_the_results_say(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(HERE)
    text = DOCUMENT.read_text(encoding="utf-8")
    assert written(text) == text


def test_a_table_says_where_it_was_measured() -> None:
    assert (
        commits({"assets": {"a": {"commit": "two"}, "b": {"commit": "one"}}}) == "commit one, two"
    )


def test_the_readme_says_what_the_results_say(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(HERE)
    text = README.read_text(encoding="utf-8")
    assert introduced(text) == text
