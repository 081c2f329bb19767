"""Seconds for 10,000 queries (paper, section 5), with networks of the published shape."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from benchmarks.paper.row import Comparison
from benchmarks.studies.decoder import best_seconds, chart_and_uv, random_network
from nispcodec.infer.evaluate import evaluate
from nispcodec.train.tasks import paper_chart, paper_sdf, paper_uv

TABLE = "Queries (section 5)"
POINTS, CHARTS = 10_000, 16
DIFFERS = "published: RTX 2070 SUPER; ours: this processor, numpy, random weights"


def queries() -> Iterator[Comparison]:
    """Distances; charts and UVs together."""
    points = np.random.default_rng(0).uniform(-1, 1, (POINTS, 3)).astype(np.float32)
    sdf, chart, uv = map(random_network, (paper_sdf(), paper_chart(CHARTS), paper_uv(CHARTS)))
    seconds = best_seconds(lambda: evaluate(sdf, points))
    yield Comparison(TABLE, "10,000 distances", 0.3, seconds, "s", DIFFERS)
    seconds = best_seconds(lambda: chart_and_uv(chart, uv, points))
    yield Comparison(TABLE, "10,000 charts and UVs", 0.6, seconds, "s", DIFFERS)
