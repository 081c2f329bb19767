from __future__ import annotations

import numpy as np
import pytest

from benchmarks.headline.pictures import likeness, silhouette, targets
from benchmarks.measuring.target import Target
from benchmarks.paper.pictures import (
    SIZE,
    PointObjective,
    _of_size,
    fitted,
    sight,
    without_charts,
)
from nispcodec.core.network import NetworkSpec
from nispcodec.core.sample_set import SampleSet
from nispcodec.infer.evaluate import evaluate
from nispcodec.model import NispModel
from nispcodec.render.camera import Camera
from nispcodec.render.views import scene_of
from nispcodec.train.config import TrainConfig
from nispcodec.train.task import Schedule, Task
from tests import tiny
from tests.metrics.shapes import sphere


def test_targets_say_what_was_missed() -> None:
    target = Target("PSNR", ("pictures", "psnr"), 33, at_least=True)
    assert "MISSED" in target.line("spot", {"pictures": {"psnr": 32.9}})
    assert "MISSED" not in target.line("spot", {"pictures": {"psnr": 33.1}})
    assert "MISSED" in Target("s", ("s",), 6).line("spot", {"s": 6.1})


def test_only_spot_is_timed_and_three_assets_must_look_alike() -> None:
    names = {asset: [each.name for each in targets(asset)] for asset in ("spot", "boombox")}
    assert "512: seconds" in names["spot"]
    assert "PSNR, dB" in names["spot"]
    assert names["boombox"] == ["rays lost", "missed, of its own mesh"]


def test_equal_scenes_are_alike(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("benchmarks.headline.pictures.SIZE", 48)
    monkeypatch.setattr("benchmarks.headline.pictures.VIEWS", 1)
    ball, small = scene_of(sphere()), scene_of(sphere(0.5), scene_of(sphere()).frame)
    assert likeness(ball, ball)["mse"] == 0
    assert not any(silhouette(ball, ball, ball).values())
    counts = silhouette(ball, ball, small)
    assert counts["missed"] == pytest.approx(0.75, abs=0.02)
    assert counts["added"] == 0
    assert likeness(ball, small)["psnr"] < 20


def test_the_color_network_is_no_larger_than_what_it_stands_for() -> None:
    for weights in (500, 5_000, 11_000):
        spec = _of_size(weights)
        wider = NetworkSpec(hidden=tuple(width + 1 for width in spec.hidden), outputs=3)
        assert spec.weight_count <= weights < wider.weight_count


def test_sights_are_painted_where_the_surface_is() -> None:
    model = NispModel(tiny.document())
    seen = sight(scene_of(model), Camera())
    np.testing.assert_allclose(model.sdf(seen.points, "normalized"), 0, atol=1e-3)
    painted = seen.painted(lambda points: np.zeros((len(points), 3), np.float32))
    assert (painted == 0).all(axis=2).sum() == len(seen.pixels)
    assert painted[0, 0].tolist() == [1, 1, 1]
    assert painted.shape == (SIZE, SIZE, 3)


def test_without_charts_every_point_has_one_uv() -> None:
    free = tiny.random_network(NetworkSpec((8,), 2))
    points = np.random.default_rng(0).uniform(-0.5, 0.5, (20, 3))
    model = without_charts(NispModel(tiny.document()), free)
    first, second = (model.uv(points, charts=np.full(20, chart)) for chart in (0, 1))
    np.testing.assert_array_equal(first, second)


def test_networks_of_uvs_and_of_colors_are_fitted() -> None:
    points = np.random.default_rng(0).uniform(-0.1, 0.1, (500, 3)).astype(np.float32)
    tasks = []
    for name, outputs in (("unconditioned", 2), ("color", 3)):
        wanted = 0.5 + 4 * points[:, :outputs]
        samples = SampleSet(points, points[:, 0], np.zeros(500, np.int32), wanted)
        objective = PointObjective(TrainConfig().loss)
        spec, schedule = NetworkSpec((16,), outputs), Schedule(300, 64, 3e-3)
        tasks.append(Task(name, spec, samples, samples, objective, schedule))
    for name, network in fitted(tasks, 0, 1).items():
        outputs = 2 if name == "unconditioned" else 3
        found = evaluate(network, points)
        assert np.abs(found - 0.5 - 4 * points[:, :outputs]).mean() < 0.1
