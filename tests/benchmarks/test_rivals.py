from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("DracoPy", reason="peers: extra `bench`")
pytest.importorskip("meshoptimizer", reason="extra `simplify`")

from benchmarks.assets.corners import corners_of, mesh_of
from benchmarks.assets.source import Source
from benchmarks.codecs import Setting, draco, meshopt
from benchmarks.rate_distortion.rivals import Trial, ruler, trials, worth
from nispcodec.io.save import write_mesh
from nispcodec.procedural.mug import sample_asset


def trial(size: int, distance: float, uv: float) -> Trial:
    return Trial("draco", {"qp": size}, size, distance, uv)


def test_what_no_mix_of_others_beats_in_any_error_is_measured_in_full() -> None:
    near, textured = trial(300, 5e-4, 9e-3), trial(310, 9e-4, 1e-3)
    beaten, smallest = trial(320, 9.5e-4, 9e-3), trial(10, 2e-3, 1e-1)
    assert worth([beaten, textured, smallest, near]) == [textured, smallest, near]


def test_trials_are_made_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made = [trial(300, 5e-4, 9e-3)]
    monkeypatch.setattr("benchmarks.rate_distortion.rivals.tried", lambda source: iter(made))
    source = Source(tmp_path / "a.obj")
    assert trials(source, tmp_path / "t") == made
    made.clear()
    assert len(trials(source, tmp_path / "t")) == 1


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
