from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from benchmarks.rate_distortion.bjontegaard import delta_rate, front
from benchmarks.rate_distortion.rows import NAMES, as_csv, from_csv, row
from benchmarks.rate_distortion.summary import bytes_at, bytes_between, duels, summarized
from nispcodec.core.arrays import Float64Array

ERRORS = np.geomspace(1e-2, 1e-4, 8)


def power_law(factor: float, errors: Float64Array = ERRORS) -> list[tuple[float, float]]:
    return [(factor * error**-0.7, error) for error in errors]


def test_delta_rate_of_known_curves() -> None:
    assert delta_rate(power_law(10), power_law(10)) == pytest.approx(0)
    assert delta_rate(power_law(10), power_law(5)) == pytest.approx(-0.5)
    assert delta_rate(power_law(10), power_law(30)) == pytest.approx(2)
    shifted = power_law(20, np.geomspace(5e-3, 2e-4, 6))
    assert delta_rate(power_law(10), shifted) == pytest.approx(1)


def test_delta_rate_wants_points_and_a_common_range() -> None:
    assert delta_rate(power_law(10), power_law(5)[:4]) is None
    assert delta_rate(power_law(10), power_law(5, np.geomspace(1, 1e-1, 6))) is None
    assert delta_rate(power_law(10), [*power_law(5)[:2], *[(1e6, 1.0)] * 5]) is None


def test_delta_rate_counts_only_points_that_are_worth_their_bytes() -> None:
    wasted = [(1e6, 1.0), (2e6, 1.0)]
    assert delta_rate(power_law(10), [*power_law(5)[:3], *wasted]) == pytest.approx(-0.5)


def test_front_drops_what_is_not_worth_its_bytes() -> None:
    assert front([(3, 0.2), (1, 1.0), (2, 1.5), (4, 0.2)]).tolist() == [[1, 1.0], [3, 0.2]]
    assert bytes_at([(100, 1e-2), (200, 1e-3), (150, 2e-3)], 5e-3) == 150
    assert bytes_at([(100, 1e-2)], 5e-3) is None


def test_bytes_between_two_settings_are_on_the_line_of_their_logarithms() -> None:
    points = [(100, 1e-2), (10_000, 1e-4), (5000, 9e-3)]
    assert 100 < (bytes_between(points, 9.5e-3) or 0) < 5000
    assert bytes_between(points[:2], 1e-3) == 1000
    assert bytes_between(points, 2e-2) == 100
    assert bytes_between(points, 1e-5) is None
    assert bytes_between([], 1) is None


def record(codec: str, size: int, distance: float, uv: float) -> dict[str, Any]:
    larger = {"mean": distance, "p99": 3 * distance, "max": 9 * distance}
    metrics = {
        "geometry": {"larger": larger, "d1_psnr": 60.0, "d2_psnr": 62.0},
        "uv": {"larger": {"mean": uv, "median": uv / 2, "p99": 9 * uv}},
        "color": {"psnr": 40.0},
    }
    cost = {"seconds": 2.0, "cpu_seconds": 1.0, "peak_bytes": 10}
    return {
        "asset": "a",
        "codec": codec,
        "setting": {"q": size},
        "bytes": size,
        "faces": 2 * size,
        "encode": cost,
        "metrics": metrics,
    }


def test_a_duel_asks_the_rival_to_be_as_good_in_both() -> None:
    records = [
        record("nisp", 500, 1e-3, 1e-3),
        record("simplified_draco", 300, 1e-3, 5e-3),
        record("simplified_draco", 400, 2e-3, 1e-3),
        record("simplified_draco", 600, 1e-3, 1e-3),
    ]
    found = duels([row(each) for each in records], "a")[0]["rival_bytes"]
    assert found == {"distance": 300, "uv": 400, "uv_median": 400, "distance and uv": 600}


def test_failed_points_are_rows_but_no_results() -> None:
    failed = {"asset": "a", "codec": "nisp", "setting": {}, "failure": "no luck"}
    rows = [row(each) for each in (failed, record("nisp", 500, 1e-3, 1e-3))]
    assert rows[0]["problem"] == "no luck"
    assert rows[0]["bytes"] is None
    assert rows[1]["color"] == pytest.approx(0.01)
    summary = summarized(rows)
    assert [duel["bytes"] for duel in summary["against_rival"]["a"]] == [500]
    assert summary["costs"]["nisp"]["encode_seconds"] == 2.0
    text = as_csv(rows)
    assert text.splitlines()[0].split(",") == list(NAMES)
    assert from_csv(text) == rows
