"""A grid of distances: where its samples are, in parts, in a file."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from nispcodec.core import sdf_grid
from nispcodec.core.arrays import Float32Array, Float64Array
from nispcodec.core.errors import NispError
from nispcodec.core.progress import Progress
from nispcodec.core.sdf_grid import SdfGrid


def slope(points: Float64Array) -> Float32Array:
    return (points @ [1.0, 20.0, 300.0]).astype(np.float32)


def grid(distance: Callable[[Float64Array], Float32Array] = slope) -> SdfGrid:
    return SdfGrid((-1.0, 0.5, 2.0), 0.25, (7, 3, 2), distance)


def test_a_value_is_the_distance_at_its_place() -> None:
    values = grid().values()
    assert values.shape == (7, 3, 2)
    expected = slope(np.array([[-1.0 + 0.25 * 5, 0.5 + 0.25 * 2, 2.0 + 0.25]]))
    assert values[5, 2, 1] == expected[0]


def test_points_are_asked_a_few_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sdf_grid, "BLOCK", 13)
    asked = []

    def counted(points: Float64Array) -> Float32Array:
        asked.append(len(points))
        return slope(points)

    assert np.array_equal(grid(counted).values(), grid().values())
    assert asked == [12, 12, 12, 6]


def test_a_file_says_where_its_values_are(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sdf_grid, "BLOCK", 13)
    told: list[Progress] = []
    grid().save(tmp_path / "field.npz", told.append)
    with np.load(tmp_path / "field.npz", allow_pickle=False) as file:
        assert np.array_equal(file["sdf"], grid().values())
        assert file["sdf"].dtype == np.float32
        assert file["origin"].tolist() == [-1.0, 0.5, 2.0]
        assert float(file["spacing"]) == 0.25
        assert str(file["sign"]) == "negative inside"
        assert str(file["units"]).startswith("those of the asset; sdf[i, j, k] is at origin")
    assert [each.step for each in told] == [2, 4, 6, 7]
    assert told[-1].overall == 1


def test_a_stopped_write_leaves_nothing(tmp_path: Path) -> None:
    def stop(_: Progress) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        grid().save(tmp_path / "field.npz", stop)
    assert not list(tmp_path.iterdir())


def test_a_full_disk_is_told_before_the_work(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def never(points: Float64Array) -> Float32Array:
        raise AssertionError("asked")

    monkeypatch.setattr(shutil, "disk_usage", lambda path: type("", (), {"free": 167}))
    with pytest.raises(NispError, match=r"field\.npz: expected room for 168 bytes, found 167 free"):
        grid(never).save(tmp_path / "field.npz")
    assert not list(tmp_path.iterdir())
