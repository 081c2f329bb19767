"""Normals of a file as creases: the edges over which they jump."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.core.arrays import FloatArray, Int64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.connectivity import row_ids
from nispcodec.core.creases import breaking, face_normals, side_pairs

# Normals of one point that differ by less are the same but for rounding and how they were averaged.
ALIKE = np.radians(5)


def with_creases(
    mesh: TexturedMesh, normals: FloatArray, groups: Int64Array | None = None
) -> TexturedMesh:
    """The mesh with the creases that its corners' normals (m, 3, 3) have; NaN stands for none.

    Faces without normals are flat, unless they are of one smoothing group (m,) above 0.
    """
    places = row_ids(mesh.positions + 0.0)[mesh.faces]
    # Powers of two change no digit, and no square of what they leave is too large.
    _, powers = np.frexp(np.abs(normals).max(axis=2, keepdims=True))
    normals = np.ldexp(normals, -powers)
    lengths = np.linalg.norm(normals, axis=2, keepdims=True)
    usable = np.isfinite(lengths) & (lengths > 0)
    bare = ~usable.all(axis=(1, 2))
    flat = np.repeat(face_normals(mesh.corners)[:, None], 3, axis=1)
    own = np.divide(normals, lengths, out=flat, where=usable).reshape(-1, 3)
    pairs = mine, other = side_pairs(places)
    same = places.ravel()[mine] == places.ravel()[other]
    after_mine, after_other = (each - each % 3 + (each + 1) % 3 for each in pairs)
    first, second = np.where(same, other, after_other), np.where(same, after_other, other)
    ends = ((mine, first), (after_mine, second))
    cosines = (np.einsum("ki,ki->k", own[one], own[two]) for one, two in ends)
    alike = np.minimum(*cosines) >= np.cos(ALIKE)
    if groups is not None:
        one, two = mine // 3, other // 3
        alike |= bare[one] & bare[two] & (groups[one] == groups[two]) & (groups[one] > 0)
    return replace(mesh, creases=breaking(pairs, alike, len(mesh.faces)))
