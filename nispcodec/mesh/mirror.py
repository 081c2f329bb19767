"""Mirror symmetry: a network that sees |x| in place of x has to hold only half of the surface.

Most assets that are modelled in halves are not quite symmetric: a bracket on one side, an engraved
number. There the network is told |x| and x, and has to hold the half and what differs.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nispcodec.asset import FloatArray
from nispcodec.mesh.samples import Sampler, SampleSet, uniform_surface

PROBES = 2_000
JITTER = 5e-3

SYMMETRIC = 3e-5
"""Up to this mean difference (normalised frame) of the SDF at a point and at its mirror image.

Assets modelled in two halves stay below 1e-5; a small part on one side only (exploding_barrel in z)
makes 1e-4 to 2e-4 and must not be lost.
"""

ALIKE = 2e-3
"""Distances and texture coordinates that differ by less count as the same."""

MOSTLY_SDF, MOSTLY_UV = 0.97, 0.9
"""The shares of alike probes from which on an axis is worth a coordinate more.

Of a surface less alike (gz_polaris, 0.965) ghosts appear on the wrong side; a UV network has none.
"""


@dataclass(frozen=True)
class Mirrors:
    """For the SDF, and for charts and UVs: `mirror` as in `nispcodec.network.NetworkSpec`."""

    sdf: int
    uv: int


def mirrors(sampler: Sampler) -> Mirrors:
    """About which of the planes x, y, z = 0 of the normalised frame an asset is symmetric.

    Told by the same random points for every seed; what the sampler draws next is not touched.
    """
    points = _probes(sampler, np.random.default_rng(0))
    here = sampler.label(points)
    sdf = uv = 0
    for axis, signs in enumerate(1.0 - 2.0 * np.eye(3)):
        there = sampler.label(points * signs)
        whole, sided = 1 << axis, 9 << axis
        off = np.abs(there.sdf - here.sdf)
        if off.mean() < SYMMETRIC:
            sdf |= whole
        elif (off < ALIKE).mean() > MOSTLY_SDF:
            sdf |= sided
        if ((off < ALIKE) & _same_uv(here, there)).mean() > MOSTLY_UV:
            uv |= sided
    return Mirrors(sdf, uv)


def unlike(sampler: Sampler, count: int, spread: float) -> list[SampleSet]:
    """For each axis that is told by its side, samples where the asset is not like its image.

    Of `count` mirror images of points near the surface those whose distance is another one: a
    network that is told |x| puts a ghost of what is on one side only there, and no other samples
    would see it.
    """
    near = sampler.near(count, spread)
    sided = mirrors(sampler).sdf >> 3
    found = []
    for axis, signs in enumerate(1.0 - 2.0 * np.eye(3)):
        if sided >> axis & 1:
            there = sampler.label(near.points * signs)
            found.append(there[np.abs(there.sdf - near.sdf) > ALIKE])
    return found


def _same_uv(here: SampleSet, there: SampleSet) -> NDArray[np.bool_]:
    same: NDArray[np.bool_] = (np.abs(here.uv - there.uv) < ALIKE).all(axis=1)
    return same


def _probes(sampler: Sampler, random: np.random.Generator) -> FloatArray:
    """(PROBES, 3) points on either side of the surface, near enough for any part to be seen."""
    surface, _ = uniform_surface(random, sampler.solid.pieces, PROBES)
    return surface + random.normal(scale=JITTER, size=surface.shape)
