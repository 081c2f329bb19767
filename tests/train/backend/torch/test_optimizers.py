"""Muon and SOAP: they find minima; Muon evens singular values."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import pytest
import torch

from nispcodec.train.backend.torch.muon import Muon, orthogonal
from nispcodec.train.backend.torch.soap import Soap


@pytest.mark.parametrize(
    ("kind", "rate", "decades"), [(Soap, 0.05, 3), (partial(Muon, share=0.1), 0.5, 1)]
)
def test_matrices_find_the_minimum_of_a_badly_scaled_quadratic(
    kind: Callable[..., Soap | Muon], rate: float, decades: int
) -> None:
    """Two matrices of one shape and one of another, in no order: all are moved together."""
    torch.manual_seed(0)
    first, second, third = torch.split(torch.arange(54), [24, 24, 6])
    matrices = [(second.view(4, 6), 1.0), (first.view(4, 6), 1.0), (third.view(3, 2), 0.5)]
    target = torch.randn(54)
    scales = torch.cat([torch.logspace(-decades, 0, 6).repeat(8), torch.ones(6)])
    weights = torch.zeros(54, requires_grad=True)
    optimizer = kind(weights, matrices)
    for step in range(600):
        weights.grad = (weights.detach() - target) * scales**2
        optimizer.step(rate * (1 - step / 600))
    assert torch.allclose(weights, target, atol=0.02)


@pytest.mark.parametrize("shape", [(4, 6), (6, 4), (5, 5)])
def test_orthogonal_leaves_the_directions_and_evens_the_singular_values(
    shape: tuple[int, int],
) -> None:
    torch.manual_seed(0)
    left, _, right = torch.linalg.svd(torch.randn(3, *shape), full_matrices=False)
    values = torch.logspace(-1, 1, 3 * min(shape)).view(3, -1)
    found = orthogonal(left @ torch.diag_embed(values) @ right)
    inner = left.mT @ found @ right.mT
    even = inner.diagonal(dim1=1, dim2=2)
    assert torch.all((even > 0.6) & (even < 1.3))
    assert torch.allclose(inner, torch.diag_embed(even), atol=1e-3)
