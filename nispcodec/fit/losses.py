"""What the networks minimise, and what says how good they are."""

from __future__ import annotations

from torch import Tensor
from torch.nn import functional

from nispcodec.fit.module import Module
from nispcodec.fit.task import Batch

NEAR = 0.01
"""Distances (normalised frame) well below this count in full in the relative loss."""

FAR_OFF = 0.01
"""A UV that is further off than this is wrong, however far."""

SIGN_WEIGHT = 1.8
"""Below 2 the loss is least where the field is the distance; above, near points are pushed away."""
SIGN_SOFTNESS = 2e-3
"""How sure of its sign a field should be: about this far from zero (normalised frame)."""


def distance_error(module: Module, batch: Batch) -> Tensor:
    """Mean |f - SDF| (paper, eq. 6)."""
    return (module(batch.points)[:, 0] - batch.sdf).abs().mean()


def relative_distance_loss(module: Module, batch: Batch) -> Tensor:
    """Mean |f - SDF| / (|SDF| + NEAR): the nearer to the surface, the more an error costs.

    The logistic loss of the sign comes on top, or the fit settles for |SDF| where detail is fine:
    small on the surface, and never crossing zero.
    """
    field = module(batch.points)[:, 0]
    wrong_side = functional.softplus(-field * batch.sdf.sign() / SIGN_SOFTNESS) * SIGN_SOFTNESS
    error = (field - batch.sdf).abs() + SIGN_WEIGHT * wrong_side
    return (error / (batch.sdf.abs() + NEAR)).mean()


def chart_loss(module: Module, batch: Batch) -> Tensor:
    """Cross-entropy of the chart."""
    return functional.cross_entropy(module(batch.points), batch.chart)


def chart_error(module: Module, batch: Batch) -> Tensor:
    """Share of points whose chart is predicted wrong."""
    return (module(batch.points).argmax(dim=1) != batch.chart).float().mean()


def uv_loss(module: Module, batch: Batch) -> Tensor:
    """Mean absolute error of u and v given the true chart."""
    return (module(batch.points, batch.chart) - batch.uv).abs().mean()


def uv_error(module: Module, batch: Batch) -> Tensor:
    """Mean distance in the network's UV square, given the true chart; `FAR_OFF` where it is more.

    Without that limit a few hard places decide how wide a network is taken for all the rest.
    """
    off = (module(batch.points, batch.chart) - batch.uv).norm(dim=1)
    return off.clamp(max=FAR_OFF).mean()
