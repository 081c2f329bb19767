"""Mirror symmetry: a network that sees |x| in place of x has to hold only half of the surface.

Most assets that are modeled in halves are not quite symmetric: a bracket on one side, an engraved
number. There the network is told |x| and x, and has to hold the half and what differs.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int64Array
from nispcodec.dataset.sample_set import SampleSet
from nispcodec.geometry.surface_points import uniform_surface

PROBES = 2_000
JITTER = 5e-3

SYMMETRIC = 3e-5
"""Up to this mean difference (normalized frame) of the SDF at a point and at its mirror image.

Assets modeled in two halves stay below 1e-5; a small part on one side only (exploding_barrel in z)
makes 1e-4 to 2e-4 and must not be lost.
"""

ALIKE = 2e-3
"""Distances and texture coordinates that differ by less count as the same."""

MOSTLY_SDF, MOSTLY_UV = 0.95, 0.9
"""The shares of alike probes from which on an axis is worth a coordinate more."""

TWIN = 0.5
"""The share of a chart's points whose image lies on its twin; charts may be cut differently."""


@dataclass(frozen=True)
class Mirrors:
    """For the SDF, and for charts and UVs: `mirror` as in `nispcodec.core.network.NetworkSpec`."""

    sdf: int
    uv: int


Label = Callable[[Float64Array], SampleSet]
"""What there is at points (n, 3) of the normalized frame."""


def mirrors(label: Label, pieces: Float64Array) -> Mirrors:
    """About which of the planes x, y, z = 0 of the normalized frame an asset is symmetric.

    Told by random points around its `pieces` (p, 3, 3), always the same.
    """
    points = _probes(pieces)
    here = label(points)
    sdf = uv = 0
    for axis in range(3):
        there = label(points * _flip(axis))
        whole, sided = 1 << axis, 9 << axis
        off = np.abs(there.sdf - here.sdf)
        if off.mean() < SYMMETRIC:
            sdf |= whole
        elif (off < ALIKE).mean() > MOSTLY_SDF:
            sdf |= sided
        if ((off < ALIKE) & _same_uv(here, there)).mean() > MOSTLY_UV:
            uv |= sided
    return Mirrors(sdf, uv)


def unlike(label: Label, near: SampleSet, sided: int) -> list[SampleSet]:
    """For each axis that is told by its side, samples where the asset is not like its image.

    Of the mirror images of points near the surface those whose distance is another one: a network
    that is told |x| puts a ghost of what is on one side only there, and no other samples would see
    it. `sided` has a bit for each axis.
    """
    found = []
    for axis in _axes(sided):
        there = label(near.points * _flip(axis))
        found.append(there[np.abs(there.sdf - near.sdf) > ALIKE])
    return found


def twins(label: Label, surface: SampleSet, mirrored: int) -> Int64Array:
    """Pairs (t, 2) of charts that are mirror images of each other, with the same UVs.

    Most of a chart's points of the `surface` have their image on its twin. `mirrored` has a bit for
    each axis.
    """
    sizes = np.bincount(surface.chart)
    found = [np.zeros((0, 2), dtype=np.int64)]
    for axis in _axes(mirrored):
        there = label(surface.points * _flip(axis))
        same = (np.abs(there.sdf - surface.sdf) < ALIKE) & _same_uv(surface, there)
        both = np.stack([surface.chart, there.chart], axis=1)[same]
        pairs, points = np.unique(both, axis=0, return_counts=True)
        found.append(pairs[points >= TWIN * sizes[pairs[:, 0]]].astype(np.int64))
    return np.concatenate(found)


def folded(points: Float64Array, mirrored: int) -> Float64Array:
    """(n, 3) with the absolute value of the axes that have a bit in `mirrored`."""
    bits = [bool(mirrored >> axis & 1) for axis in range(3)]
    return np.where(bits, np.abs(points), points)


def _axes(bits: int) -> list[int]:
    return [axis for axis in range(3) if bits >> axis & 1]


def _flip(axis: int) -> Float64Array:
    signs = np.ones(3)
    signs[axis] = -1
    return signs


def _same_uv(here: SampleSet, there: SampleSet) -> BoolArray:
    same: BoolArray = (np.abs(here.uv - there.uv) < ALIKE).all(axis=1)
    return same


def _probes(pieces: Float64Array) -> Float64Array:
    """(PROBES, 3) points on either side of the surface, near enough for any part to be seen."""
    random = np.random.default_rng(0)
    surface, _ = uniform_surface(random, pieces, PROBES)
    return surface + random.normal(scale=JITTER, size=surface.shape)
