"""A training backend: the arithmetic of a fit, and nothing of its course."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from nispcodec.core.arrays import Float32Array, Int32Array, Int64Array, IntArray
from nispcodec.train.task import Task

ErrorRadii = Callable[[Float32Array, float, bool], Float32Array]
"""Of the samples of a task: (field (n,), limit, floaters) -> error radii (n,), as in
`nispcodec.dataset.hard_examples.error_radii`."""


class Trainer(Protocol):
    """One network under training; its weights are one vector (`nispcodec.train.layout`).

    threads  cores that `steps` may use; the result is the same with any number
    """

    threads: int

    @property
    def weights(self) -> Float32Array:
        """(weights,) as they are now; a copy."""

    @property
    def mean(self) -> Float32Array:
        """(weights,) their running mean; a copy."""

    def steps(self, rows: Int32Array, rates: Float32Array) -> Float32Array:
        """Go k steps: samples `rows` (k, batch), rates (k,) -> the loss before each (k,)."""

    def restart(self, weights: Float32Array) -> None:
        """Go on from these weights (weights,), with an optimizer that remembers nothing."""

    def gradient(self, rows: Int32Array) -> tuple[float, Float32Array]:
        """The loss of the samples `rows` (batch,) and its derivatives (weights,)."""

    def outputs(
        self, weights: Float32Array, points: Float32Array, charts: IntArray
    ) -> Float32Array:
        """The network's answers (n, outputs) with other weights, for points (n, 3), charts (n,)."""

    def slopes(
        self,
        weights: Float32Array,
        points: Float32Array,
        charts: IntArray,
        directions: Float32Array,
        places: Int64Array | None = None,
    ) -> Float32Array:
        """Derivatives (n, weights) of each point's outputs along its direction (n, outputs).

        (n, m) by the weights at `places` (m,) alone.
        """


class Engine(Protocol):
    """A backend: makes trainers."""

    name: str

    def trainer(self, task: Task, weights: Float32Array, kept: Float32Array | None) -> Trainer:
        """A trainer that starts from `weights`; what `kept` has 0 for stays 0."""

    def error_radii(self, task: Task) -> ErrorRadii:
        """The error radii of the task's samples."""
