"""Mirror symmetry: a network that sees |x| in place of x has to hold only half of the surface."""

from __future__ import annotations

import numpy as np

from nispcodec.asset import FloatArray
from nispcodec.mesh.samples import Sampler, uniform_surface

PROBES = 2_000
JITTER = 5e-3

SYMMETRIC = 3e-5
"""Up to this mean difference (normalised frame) of the SDF at a point and at its mirror image.

Assets modelled in two halves stay below 1e-5; a small part on one side only (exploding_barrel in z)
makes 1e-4 to 2e-4 and must not be lost.
"""


def mirrored_axes(sampler: Sampler) -> tuple[bool, bool, bool]:
    """About which of the planes x, y, z = 0 of the normalised frame the SDF is symmetric.

    Told by the same random points for every seed; what the sampler draws next is not touched.
    """
    probes = _probes(sampler, np.random.default_rng(0))
    distance = sampler.field.closest(probes).sdf
    x, y, z = (
        bool(np.abs(sampler.field.closest(probes * signs).sdf - distance).mean() < SYMMETRIC)
        for signs in 1.0 - 2.0 * np.eye(3)
    )
    return x, y, z


def _probes(sampler: Sampler, random: np.random.Generator) -> FloatArray:
    """(PROBES, 3) points on either side of the surface, near enough for any part to be seen."""
    surface, _ = uniform_surface(random, sampler.solid.pieces, PROBES)
    return surface + random.normal(scale=JITTER, size=surface.shape)
