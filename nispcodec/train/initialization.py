"""The weights that a fit starts from, as the vector of `nispcodec.train.layout`."""

from __future__ import annotations

import math

import numpy as np

from nispcodec.core.arrays import Float32Array
from nispcodec.core.initial_weights import BITS
from nispcodec.core.network import NetworkSpec
from nispcodec.core.sample_set import SampleSet
from nispcodec.train.chart_affine import affine_maps
from nispcodec.train.layout import WeightLayout


def initial_weights(spec: NetworkSpec, w0_scale: float = 1.0) -> Float32Array:
    """(weights,) of the seed of `spec`; its first frequencies are `w0_scale` times SIREN's.

    Each tensor is within its bound (`nispcodec.core.initial_weights`). Signed axes start unseen.
    """
    integers, bounds = spec.initial_integers(spec.shapes), _bounds(spec)
    first = {
        name: (values / (1 << BITS) * bounds[name]).astype(np.float32)
        for name, values in integers.items()
    }
    first["weight.0"] *= np.float32(w0_scale)
    first["bias.0"] *= np.float32(w0_scale)
    if spec.encoding == "identity":
        first["weight.0"][:, 3 : 3 + len(spec.signed_axes)] = 0
    return np.concatenate([first[name].ravel() for name in spec.shapes])


def place_chart_affine(
    weights: Float32Array, layout: WeightLayout, samples: SampleSet, ridge: float
) -> None:
    """Start from the affine maps nearest to the UVs of the samples; changes `weights`."""
    seen = coordinates(layout.spec, samples.points).astype(np.float64)
    uvs = samples.uv.astype(np.float64)
    maps = affine_maps(seen, samples.chart, uvs, layout.spec.charts, ridge)
    parts = layout.parts(weights)
    for name, values in zip(("slopes", "offsets"), maps, strict=True):
        parts[name][:] = values


def coordinates(spec: NetworkSpec, points: Float32Array) -> Float32Array:
    """Points (n, 3) as the network sees them (n, coordinates): mirrored, then the signed axes."""
    folded = np.where(spec.mirrored, np.abs(points), points)
    return np.concatenate([folded, points[:, list(spec.signed_axes)]], axis=1)


def _bounds(spec: NetworkSpec) -> dict[str, float]:
    """How large the first numbers of every tensor are at most."""
    # Embeddings of variance 1.
    bounds = {"embedding": math.sqrt(3), "slopes": 0.0, "offsets": 0.0}
    for layer, fan_in in enumerate([spec.inputs, *spec.hidden]):
        bound = _weight_bound(spec, layer, fan_in)
        bias = bound if layer < len(spec.hidden) else 0.0
        bounds |= {f"weight.{layer}": bound, f"bias.{layer}": bias}
    return bounds


def _weight_bound(spec: NetworkSpec, layer: int, fan_in: int) -> float:
    """SIREN's initialization; He-uniform where w0 is 1 (the paper) and for relu."""
    if spec.activation == "relu" or spec.w0 == 1.0:
        return math.sqrt(6 / fan_in)
    if layer == 0:
        return spec.w0 / fan_in
    bound = math.sqrt(6 / fan_in)
    return bound if layer < len(spec.hidden) else bound / spec.w0
