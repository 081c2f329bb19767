"""Objectives: a network's loss, the error that judges it, and the cost of rounding its weights.

The three belong together: an `Objective` is one value, so that none can be forgotten. All look at
the outputs (n, k) of a network for samples; a backend has the derivative of the loss of each name
(`nispcodec.train.backend`).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from nispcodec.core.arrays import Float32Array
from nispcodec.core.sample_set import SampleSet
from nispcodec.train.config import LossConfig


@dataclass(frozen=True)
class Objective(ABC):
    """Loss, held-out error and curvature of one kind of network.

    The curvature says how fast the loss rises about where it is: what rounding the weights costs.
    """

    config: LossConfig

    loss_name: ClassVar[str]
    """By which backends know the loss."""

    own_curvature: ClassVar[bool] = True
    """The curvature is that of the loss itself, and not of something that stands for it."""

    @abstractmethod
    def loss(self, outputs: Float32Array, samples: SampleSet) -> float:
        """The number that training minimizes."""

    @abstractmethod
    def error(self, outputs: Float32Array, samples: SampleSet) -> float:
        """How far the network is off, the same whatever the loss."""

    @abstractmethod
    def ignorance(self, samples: SampleSet) -> float:
        """The error of the best constant: a network that is no better has learned nothing."""

    @property
    @abstractmethod
    def good(self) -> float:
        """An error that is fine for use: a fit that stays below it has not diverged."""

    @abstractmethod
    def factors(self, outputs: Float32Array, samples: SampleSet) -> Float32Array:
        """Curvature at outputs (n, k) -> (n, k, r).

        Each point's second derivatives by its outputs are the product of its factor and that one's
        transpose.
        """

    @property
    @abstractmethod
    def damping(self) -> float:
        """Above 0: this share of their mean is added to the second derivatives by each weight."""


class SdfObjective(Objective):
    """Mean |f - SDF| / (|SDF| + near): the nearer to the surface, the more an error costs.

    The logistic loss of the sign comes on top, or the fit settles for |SDF| where detail is fine:
    small on the surface, and never crossing zero. The error is the mean distance.
    """

    loss_name = "sdf"

    def loss(self, outputs: Float32Array, samples: SampleSet) -> float:
        """See the class."""
        field, softness = outputs[:, 0], self.config.sign_softness
        doubt = -field * np.sign(samples.sdf) / softness
        error = np.abs(field - samples.sdf)
        error += self.config.sign_weight * softness * np.logaddexp(0, doubt)
        return float((error / (np.abs(samples.sdf) + self.config.near)).mean())

    def error(self, outputs: Float32Array, samples: SampleSet) -> float:
        """Mean |f - SDF|, normalized frame."""
        return float(np.abs(outputs[:, 0] - samples.sdf).mean())

    def ignorance(self, samples: SampleSet) -> float:
        """See `Objective`."""
        return float(np.abs(samples.sdf - np.median(samples.sdf)).mean())

    @property
    def good(self) -> float:
        """See `Objective`."""
        return self.config.sdf_good

    def factors(self, outputs: Float32Array, samples: SampleSet) -> Float32Array:
        """(n, 1, 1), the kink of the absolute error rounded off."""
        field, sign, softness = outputs[:, 0], np.sign(samples.sdf), self.config.sign_softness
        wrong = _sigmoid(-field * sign / softness)
        bent = 1 / np.maximum(np.abs(field - samples.sdf), self.config.sdf_rounding)
        bent += self.config.sign_weight / softness * wrong * (1 - wrong) * np.abs(sign)
        return np.sqrt(bent / (np.abs(samples.sdf) + self.config.near))[:, None, None]

    @property
    def damping(self) -> float:
        """See `Objective`."""
        return self.config.sdf_damping


class PaperSdfObjective(SdfObjective):
    """The paper's: the mean distance (eq. 6) is both loss and error."""

    loss_name = "paper_sdf"

    def loss(self, outputs: Float32Array, samples: SampleSet) -> float:
        """Mean |f - SDF|."""
        return self.error(outputs, samples)


class ChartObjective(Objective):
    """Cross-entropy of the chart; the error is the share of points whose chart is wrong.

    The curvature is not the loss' own, which is flat wherever the chart is sure, and rounding goes
    far enough to change that: it is that of the first chart's lead over the second.
    """

    loss_name = "chart"
    own_curvature = False

    def loss(self, outputs: Float32Array, samples: SampleSet) -> float:
        """See the class."""
        right = outputs[np.arange(len(outputs)), samples.chart]
        return float((np.logaddexp.reduce(outputs, axis=1) - right).mean())

    def error(self, outputs: Float32Array, samples: SampleSet) -> float:
        """Share of points, 0 to 1."""
        return float((outputs.argmax(axis=1) != samples.chart).mean())

    def ignorance(self, samples: SampleSet) -> float:
        """See `Objective`."""
        return 1 - float(np.bincount(samples.chart).max()) / len(samples)

    @property
    def good(self) -> float:
        """See `Objective`."""
        return self.config.chart_good

    def factors(self, outputs: Float32Array, samples: SampleSet) -> Float32Array:
        """(n, charts, 1)."""
        points = np.arange(len(outputs))
        second, first = np.argpartition(outputs, -2, axis=1)[:, -2:].T
        lead = outputs[points, first] - outputs[points, second]
        doubt = _sigmoid(-lead / self.config.sure_lead)
        found = np.zeros((*outputs.shape, 1), dtype=np.float32)
        found[points, first, 0] = np.sqrt(doubt * (1 - doubt))
        found[points, second, 0] = -found[points, first, 0]
        return found

    @property
    def damping(self) -> float:
        """See `Objective`."""
        return self.config.chart_damping


class UvObjective(Objective):
    """Mean absolute error of u and v given the true chart.

    The error is the mean distance in the network's UV square, `uv_error_limit` where it is more:
    without that limit a few hard places decide how wide a network is taken for all the rest.
    """

    loss_name = "uv"

    def loss(self, outputs: Float32Array, samples: SampleSet) -> float:
        """See the class."""
        return float(np.abs(outputs - samples.uv).mean())

    def error(self, outputs: Float32Array, samples: SampleSet) -> float:
        """See the class."""
        return self._error(outputs, samples.uv)

    def ignorance(self, samples: SampleSet) -> float:
        """See `Objective`."""
        return self._error(np.median(samples.uv, axis=0), samples.uv)

    @property
    def good(self) -> float:
        """See `Objective`."""
        return self.config.uv_good

    def factors(self, outputs: Float32Array, samples: SampleSet) -> Float32Array:
        """(n, 2, 2), the kink of the absolute error rounded off."""
        off = np.maximum(np.abs(outputs - samples.uv), self.config.uv_rounding)
        found = np.zeros((*outputs.shape, outputs.shape[1]), dtype=np.float32)
        every = np.arange(outputs.shape[1])
        found[:, every, every] = np.sqrt(0.5 / off)
        return found

    @property
    def damping(self) -> float:
        """See `Objective`."""
        return self.config.uv_damping

    def _error(self, outputs: Float32Array, uvs: Float32Array) -> float:
        off = np.linalg.norm(outputs - uvs, axis=1)
        return float(np.minimum(off, self.config.uv_error_limit).mean())


def _sigmoid(values: Float32Array) -> Float32Array:
    return np.exp(-np.logaddexp(0, -values))


OBJECTIVES: dict[str, type[Objective]] = {
    "sdf": SdfObjective,
    "chart": ChartObjective,
    "uv": UvObjective,
}
"""By the name of the network."""
