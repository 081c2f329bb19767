"""Mirror symmetry: a network that sees |x| in place of x has to hold only half of the surface.

Most assets that are modeled in halves are not quite symmetric: a bracket on one side, an engraved
number. There the network sees |x| and x (a signed axis), and has to hold the half and what differs.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int64Array
from nispcodec.core.sample_set import SampleSet
from nispcodec.geometry.config import SymmetryConfig
from nispcodec.geometry.labeling import Labeling
from nispcodec.geometry.surface_points import uniform_surface


@dataclass(frozen=True)
class Symmetry:
    """The planes of symmetry: `mirror` as in `nispcodec.core.network.NetworkSpec`.

    sdf  of the SDF network
    uv   of the chart and UV networks
    """

    sdf: int
    uv: int


def find_symmetry(label: Labeling, config: SymmetryConfig = SymmetryConfig()) -> Symmetry:
    """Find about which of the planes x, y, z = 0 of the normalized frame an asset is symmetric.

    Labels of random points near the surface, always the same ones, are compared with those of their
    mirror images.
    """
    points = _probes(label.field.solid.pieces, config)
    here = label(points)
    sdf = uv = 0
    for axis in range(3):
        there = label(points * _flip(axis))
        mirrored, with_sign = 1 << axis, 9 << axis
        off = np.abs(there.sdf - here.sdf)
        if off.mean() < config.exact:
            sdf |= mirrored
        elif (off < config.alike).mean() > config.mostly_sdf:
            sdf |= with_sign
        same = (off < config.alike) & _same_uv(here, there, config.alike)
        if same.mean() > config.mostly_uv:
            uv |= with_sign
    return Symmetry(sdf, uv)


def asymmetric_samples(
    label: Labeling, near: SampleSet, signed_axes: int, alike: float
) -> list[SampleSet]:
    """For each signed axis, samples where the asset is not like its mirror image.

    They are the mirror images of points `near` the surface whose distance differs by more than
    `alike`. A part that is on one side only has its mirror image there in a network that sees |x|,
    and no other samples would tell. `signed_axes` has a bit for each axis.
    """
    found = []
    for axis in _axes(signed_axes):
        there = label(near.points * _flip(axis))
        found.append(there[np.abs(there.sdf - near.sdf) > alike])
    return found


def mirrored_charts(
    label: Labeling, surface: SampleSet, mirrored: int, config: SymmetryConfig
) -> Int64Array:
    """Pairs (t, 2) int64 of charts that are mirror images of each other, with the same UVs.

    The share `config.mirrored` of the first chart's samples on the `surface` have their mirror
    image on the second. `mirrored` has a bit for each axis.
    """
    sizes = np.bincount(surface.chart)
    found = [np.zeros((0, 2), dtype=np.int64)]
    for axis in _axes(mirrored):
        there = label(surface.points * _flip(axis), signed=False)
        same = np.abs(there.sdf - surface.sdf) < config.alike
        same &= _same_uv(surface, there, config.alike)
        both = np.stack([surface.chart, there.chart], axis=1)[same]
        pairs, points = np.unique(both, axis=0, return_counts=True)
        found.append(pairs[points >= config.mirrored * sizes[pairs[:, 0]]].astype(np.int64))
    return np.concatenate(found)


def folded(points: Float64Array, mirrored: int) -> Float64Array:
    """Points (n, 3) with the absolute value of the coordinates that have a bit in `mirrored`."""
    bits = [bool(mirrored >> axis & 1) for axis in range(3)]
    return np.where(bits, np.abs(points), points)


def _axes(bits: int) -> list[int]:
    return [axis for axis in range(3) if bits >> axis & 1]


def _flip(axis: int) -> Float64Array:
    signs = np.ones(3)
    signs[axis] = -1
    return signs


def _same_uv(here: SampleSet, there: SampleSet, alike: float) -> BoolArray:
    same: BoolArray = (np.abs(here.uv - there.uv) < alike).all(axis=1)
    return same


def _probes(pieces: Float64Array, config: SymmetryConfig) -> Float64Array:
    """(probes, 3) points on either side of the surface, near enough for any part to be seen."""
    random = np.random.default_rng(0)
    surface, _ = uniform_surface(random, pieces, config.probes)
    return surface + random.normal(scale=config.jitter, size=surface.shape)
