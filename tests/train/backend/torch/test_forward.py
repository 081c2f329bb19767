"""The torch side computes what the numpy side computes."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from nispcodec.core.network import NetworkSpec
from nispcodec.infer.evaluate import evaluate
from nispcodec.train.backend.torch.forward import Forward
from nispcodec.train.initialization import initial_weights
from nispcodec.train.layout import WeightLayout
from nispcodec.train.tasks import paper_chart, paper_sdf, paper_uv

SPECS = {
    "sine": NetworkSpec((9, 7), 3),
    "relu tanh": NetworkSpec((5,), 1, activation="relu", output="tanh"),
    "fourier sigmoid": NetworkSpec((6,), 2, "fourier", 4, w0=1.0, output="sigmoid"),
    "scalar": NetworkSpec((6,), 2, "fourier", 3, "scalar", charts=5, w0=1.0),
    "frames": NetworkSpec(
        (6, 6), 2, conditioning="chart_affine", charts=5, embedding=3, mirror=0b011011
    ),
    "paper uv": paper_uv(3),
    "mirror": NetworkSpec((9, 7), 1, mirror=0b101),
    "sided": NetworkSpec((9, 7), 1, mirror=0b101101),
    "mirror scalar": NetworkSpec((6,), 2, "fourier", 3, "scalar", charts=5, w0=1.0, mirror=0b010),
}


@pytest.mark.parametrize("name", SPECS)
def test_both_sides_agree(name: str) -> None:
    spec = SPECS[name]
    layout, weights = WeightLayout(spec), initial_weights(spec)
    random = np.random.default_rng(0)
    points = random.uniform(-1, 1, (50, 3)).astype(np.float32)
    charts = random.integers(0, 5 if spec.charts == 5 else max(spec.charts, 1), 50)
    expected = Forward(layout, "cpu")(*map(torch.from_numpy, (weights, points, charts))).numpy()
    conditioned = spec.conditioning != "none"
    found = evaluate(layout.network(weights), points, charts if conditioned else None)
    assert found == pytest.approx(expected, abs=2e-4)


def test_the_published_weight_counts() -> None:
    """Paper, section 4.3, for an object of 190 charts."""
    assert paper_uv(190).weight_count == 31_874
    assert paper_chart(190).weight_count == 43_454
    assert paper_sdf().weight_count == 31_169
