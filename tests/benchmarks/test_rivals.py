from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("DracoPy", reason="peers: extra `bench`")
pytest.importorskip("meshoptimizer", reason="extra `simplify`")

from benchmarks.assets.corners import corners_of, mesh_of
from benchmarks.assets.source import Source
from benchmarks.codecs import Setting, draco, meshopt
from benchmarks.rate_distortion.rivals import Trial, between, deciding, ruler, stored
from nispcodec.io.save import write_mesh
from nispcodec.procedural.mug import sample_asset

OURS: dict[str, Any] = {"bytes": 320, "distance": 6e-4, "uv": 2e-3}


def trial(size: int, distance: float, uv: float, kept: float = 0.25) -> Trial:
    setting: Setting = {"surface": "all", "kept": kept, "qp": 10, "qt": 10}
    return Trial("simplified_draco", setting, size, distance, uv)


def test_what_is_as_near_and_small_and_what_is_nearest_as_small_decides() -> None:
    far = [trial(size, 1e-3 - size * 1e-7, 1e-2 - size * 1e-6) for size in (10, 20, 30, 40)]
    far.append(trial(5, 2e-3, 1e-3))
    near = [trial(size, 5e-4, uv) for size, uv in ((400, 9e-3), (500, 1e-3), (600, 1e-3))]
    every = [*near, trial(700, 5e-4, 9e-3), trial(800, 5e-4, 1e-3), trial(900, 5e-4, 1e-3), *far]
    sizes = sorted({each.bytes for each in deciding(every, OURS)})
    assert sizes == [5, 20, 30, 40, 400, 500, 600, 800]


def test_other_shares_are_tried_around_what_is_about_as_near() -> None:
    every = [trial(400, 7e-4, 1e-3), trial(500, 6.9e-4, 9e-3, 0.42), trial(90, 4e-3, 1e-3, 0.125)]
    every += [trial(600, 8e-4, 1e-3, 0.59)]
    assert [setting["kept"] for _, setting in between(every, OURS)] == [0.21, 0.297, 0.353, 0.5]


def test_half_of_the_faces_are_tried_where_nothing_is_as_small_as_ours() -> None:
    coarse: Setting = {"surface": "all", "kept": 0.125, "qp": 9, "qt": 9}
    every = [trial(400, 2e-3, 1e-3, 0.125), Trial("simplified_draco", coarse, 350, 2e-3, 1e-3)]
    assert list(between(every, OURS)) == [("simplified_draco", {**coarse, "kept": 0.0625})]


def test_trials_are_made_once(tmp_path: Path) -> None:
    made = [trial(300, 5e-4, 9e-3)]
    path = tmp_path / "t" / "a.json"
    assert stored(path, lambda: made) == made
    assert stored(path, lambda: []) == made


def test_the_same_mesh_comes_back_from_meshopt_and_is_measured_as_near(tmp_path: Path) -> None:
    path = tmp_path / "mug.obj"
    write_mesh(sample_asset(), path)
    source = Source(path)
    corners = corners_of(source.mesh)
    setting: Setting = {"qp": 12, "qt": 12}
    errors = ruler(source)
    decoded = mesh_of(source, meshopt.decode_corners(meshopt.encode_corners(corners, setting)))
    theirs = draco.decode(draco.encode_corners(corners, setting), source)
    assert errors(decoded).distance == pytest.approx(errors(theirs).distance, rel=0.2)
    assert errors(decoded).uv < 2e-3
