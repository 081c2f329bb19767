"""What the pruning benchmarks read off their curves."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from benchmarks.measuring.result_file import Record
from benchmarks.paper.pruning_figure import draw, holding, tables
from benchmarks.paper.pruning_published import PUBLISHED, RATES, SIZED, SIZES
from benchmarks.studies.pruning_or_quantizing import against_quantized, table


def series() -> Record:
    """Made-up rounds of one asset and strategy, with sizes where the table wants them."""
    rates = [0.0, *RATES]
    rounds: dict[str, list[Record]] = {
        name: [
            {"rate": rate, "quality": 0.9 - rate / 2 if name == "chart" else 1e-3 * (1 + rate)}
            for rate in rates
        ]
        for name in SIZED
    }
    for name, rate in SIZED.items():
        for each in rounds[name]:
            if each["rate"] in (0.0, rate):
                each["bytes"] = dict.fromkeys(SIZES[name], 1500)
    return {"asset": "thing", "strategy": "smallest", "rounds": rounds}


def test_a_published_value_for_every_rate() -> None:
    assert len(RATES) == 10
    for networks in PUBLISHED.values():
        assert [len(values) for values in networks.values()] == [10, 10]


def test_a_curve_holds_until_it_is_a_tenth_worse() -> None:
    accuracy = [(0.0, 0.9), (0.2, 0.92), (0.4, 0.82), (0.6, 0.80), (0.8, 0.9)]
    assert holding(accuracy, "chart") == 0.4
    error = [(0.0, 1.0), (0.2, 1.09), (0.4, 1.11), (0.6, 0.9)]
    assert holding(error, "uv") == 0.2
    assert holding([(0.0, 1.0), (0.2, 2.0)], "uv") == 0.0


def test_the_figure_is_drawn_of_what_is_there(tmp_path: Path) -> None:
    for found in ([], [series()]):
        draw(found, tmp_path / "figure.png")
        assert (tmp_path / "figure.png").stat().st_size > 5000


def test_the_tables_name_what_was_measured() -> None:
    text = tables([series()])
    assert "| thing | smallest |" in text
    assert "| chart, 84.4% pruned, thing (.nisp) | 1.5 |" in text
    assert "| uv, 64.4% pruned, published (.npz) | 129.1 | 71.3 | 71.4 | 71.4 | 73.4 |" in text


def case() -> Record:
    """Quantizing alone halves the bytes for a tenth more error each time."""
    settings = [
        (0.0, 0.0, 1.0, 4000, 1.0),
        (0.0, 0.005, 1.0, 2000, 1.1),
        (0.0, 0.03, 1.0, 1000, 1.21),
        (0.5, 0.03, 1.0, 800, 1.21),
        (0.7, 0.03, 1.0, 700, 1.5),
        (0.0, 0.005, 0.5, 500, 1.1),
    ]
    names = "rate", "price", "width", "bytes", "error"
    return {"network": "sdf", "points": [dict(zip(names, each, strict=True)) for each in settings]}


def test_bytes_are_compared_at_the_same_error() -> None:
    points = case()["points"]
    assert against_quantized(case(), points[1]) == pytest.approx(1)
    assert against_quantized(case(), points[3]) == pytest.approx(0.8)
    assert math.isnan(against_quantized(case(), points[4]))
    assert against_quantized(case(), points[5]) == pytest.approx(0.25)
    assert against_quantized(case(), points[3] | {"error": 1.1**1.5}) == pytest.approx(
        800 / math.sqrt(2000 * 1000)
    )


def test_the_table_has_a_row_for_every_setting() -> None:
    rows = list(table([case(), case()]))
    assert len(rows) == 2 + 6
    assert rows[2] == "| sdf | 0% | 100% | float16 | 4,000 | 1.00 | 1.00 (2) | 2 |"
    assert rows[5] == "| sdf | 50% | 100% | 0.03 | 800 | 1.21 | 0.80 (2) | 2 |"
    assert rows[6] == "| sdf | 70% | 100% | 0.03 | 700 | 1.50 | - | 2 |"
    assert rows[7] == "| sdf | 0% | 50% | 0.005 | 500 | 1.10 | 0.25 (2) | 2 |"
