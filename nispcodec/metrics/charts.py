"""How often a model finds the chart of a point."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from nispcodec.metrics.surface import Array

Labels = NDArray[np.integer]

POINTS = 64
TIE = 1e-6


class Chooser(Protocol):
    """A model: the charts (n,) of world points (n, 3), and their UVs (n, 2) on given charts."""

    def charts(self, points: Array) -> Labels: ...

    def uv(self, points: Array, *, charts: Labels) -> NDArray[np.floating]: ...


def chart_accuracy(labels: Labels, predicted: Labels) -> float:
    """Share of points (n,) whose predicted chart is the true one."""
    return float((np.asarray(labels) == np.asarray(predicted)).mean())


def model_labels(
    model: Chooser, points: Array, uvs: Array, charts: Labels, predicted: Labels
) -> Labels:
    """The true charts (n,) of points in the model's own numbering.

    A model may number charts as it likes and give distant ones the same number. The number of one
    of the original's charts is that under which the UV network gives the chart's UVs back, judged
    on POINTS of its points; the most predicted one where several do, as without UVs.
    points (n, 3) world, uvs (n, 2), charts (n,) in the original's numbering, predicted (n,).
    """
    chosen = _some_of_each(charts, np.random.default_rng(0))
    points, uvs, voted = points[chosen], uvs[chosen], predicted[chosen]
    present, which = np.unique(charts[chosen], return_inverse=True)
    counts = np.bincount(which)
    scores = np.empty((int(predicted.max()) + 1, len(present)))
    for label in range(len(scores)):
        found = model.uv(points, charts=np.full(len(points), label, dtype=np.int32))
        losses = np.linalg.norm(found - uvs, axis=1) - TIE * (voted == label)
        scores[label] = np.bincount(which, losses) / counts
    return scores.argmin(axis=0)[np.searchsorted(present, charts)]


def _some_of_each(charts: Labels, rng: np.random.Generator) -> NDArray[np.intp]:
    """Indices of at most POINTS random points of each chart."""
    shuffled = rng.permutation(len(charts))
    order = shuffled[np.argsort(charts[shuffled], kind="stable")]
    starts = np.searchsorted(charts[order], charts[order])
    return order[np.arange(len(order)) - starts < POINTS]
