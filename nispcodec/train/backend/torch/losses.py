"""What the networks minimize, and what says how good they are."""

from __future__ import annotations

import torch
from torch import Tensor
from torch.nn import functional

from nispcodec.train.backend.torch.module import Module
from nispcodec.train.task import Batch, Curvature

NEAR = 0.01
"""Distances (normalized frame) well below this count in full in the relative loss."""

FAR_OFF = 0.01
"""A UV that is further off than this is wrong, however far."""

SIGN_WEIGHT = 1.8
"""Below 2 the loss is least where the field is the distance; above, near points are pushed away."""
SIGN_SOFTNESS = 2e-3
"""How sure of its sign a field should be: about this far from zero (normalized frame)."""

BENT_SDF, BENT_UV = 5e-5, 1e-4
"""The kink of an absolute error is taken as if it were as round as this."""

SURE = 10.0
"""A chart that leads by so many logits counts as fairly sure, when weights are rounded."""


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


def distance_factors(outputs: Tensor, batch: Batch) -> Tensor:
    """Of `relative_distance_loss`."""
    field, sign = outputs[:, 0], batch.sdf.sign()
    wrong = torch.sigmoid(-field * sign / SIGN_SOFTNESS)
    bent = 1 / (field - batch.sdf).abs().clamp(min=BENT_SDF)
    bent += SIGN_WEIGHT / SIGN_SOFTNESS * wrong * (1 - wrong) * sign.abs()
    return (bent / (batch.sdf.abs() + NEAR)).sqrt()[:, None, None]


def uv_factors(outputs: Tensor, batch: Batch) -> Tensor:
    """Of `uv_loss`."""
    bent = 0.5 / (outputs - batch.uv).abs().clamp(min=BENT_UV)
    return torch.diag_embed(bent.sqrt())


def chart_factors(outputs: Tensor, batch: Batch) -> Tensor:
    """Of `chart_loss`, seen from further off: how the first chart's lead over the second moves.

    The loss itself is flat wherever the chart is sure, and rounding goes far enough to change that.
    """
    lead, charts = outputs.topk(2, dim=1)
    doubt = torch.sigmoid((lead[:, 1] - lead[:, 0]) / SURE)
    first, second = (functional.one_hot(chart, outputs.shape[1]) for chart in charts.T)
    bent = doubt * (1 - doubt)
    return ((first - second) * bent.sqrt()[:, None])[:, :, None]


CURVATURES = {
    "sdf": Curvature(distance_factors, 1e-5),
    "chart": Curvature(chart_factors, 1e-3, own=False),
    "uv": Curvature(uv_factors, 1e-5),
}
