from __future__ import annotations

from benchmarks.readme import duel_row, replaced


def test_only_what_stands_between_the_markers_changes() -> None:
    text = "before\n<a>\nold\n<b>\nafter <b>\n"
    assert replaced(text, "<a>\n", "<b>\n", "new\n") == "before\n<a>\nnew\n<b>\nafter <b>\n"


def test_a_line_says_none_where_the_rival_is_never_as_good() -> None:
    rival = {"distance": 4000, "uv": None, "distance and uv": None}
    duels = [{"setting": "balanced", "bytes": 9500, "rival_bytes": rival}]
    rows = [{"asset": "a", "codec": "draco", "setting": "11 10", "bytes": "12345"}]
    assert duel_row("a", duels, rows) == "| a | 9.5 | 4.0 | none | 12.3 | none | none |\n"
    assert "not measured" in duel_row("a", [], rows)
