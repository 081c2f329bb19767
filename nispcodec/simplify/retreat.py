"""Moves taken back where faces would turn over."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int64Array
from nispcodec.simplify.closest import unit


def without_turns(
    faces: Int64Array, before: Float64Array, after: Float64Array, limit: float, halvings: int
) -> Float64Array:
    """Positions `after` (n, 3), but those of faces that would turn go back towards `before`.

    limit: the cosine of the angle by which a face may turn. halvings: of a move before all of it
    is taken back.
    """
    normals = unit(crosses(faces, before))
    solid = np.linalg.norm(normals, axis=1) > 0

    def wrong(positions: Float64Array) -> BoolArray:
        turned = (normals * unit(crosses(faces, positions))).sum(axis=1)
        return np.asarray(solid & (turned < limit))

    return _retreated(faces, before, after, wrong, halvings)


def without_folds(
    faces: Int64Array, before: Float64Array, after: Float64Array, halvings: int
) -> Float64Array:
    """UVs `after` (t, 2), but those of UV triangles that would turn over go back to `before`.

    halvings: of a move before all of it is taken back.
    """
    signs = np.sign(uv_areas(faces, before))

    def wrong(uvs: Float64Array) -> BoolArray:
        return np.asarray((signs != 0) & (signs * uv_areas(faces, uvs) <= 0))

    return _retreated(faces, before, after, wrong, halvings)


def _retreated(
    faces: Int64Array,
    before: Float64Array,
    after: Float64Array,
    wrong: Callable[[Float64Array], BoolArray],
    halvings: int,
) -> Float64Array:
    """Half of the way, and again, then all of it, until no face is wrong."""
    values, rounds = after.copy(), 0
    while (bad := wrong(values)).any():
        back = np.unique(faces[bad])
        if rounds >= halvings and np.array_equal(values[back], before[back]):
            return before
        share = 0.5 if rounds < halvings else 0.0
        values[back] = before[back] + share * (values[back] - before[back])
        rounds += 1
    return values


def crosses(faces: Int64Array, positions: Float64Array) -> Float64Array:
    """(m, 3): the normals of the faces, twice as long as their areas."""
    a, b, c = np.moveaxis(positions[faces], 1, 0)
    found: Float64Array = np.cross(b - a, c - a)
    return found


def uv_areas(faces: Int64Array, uvs: Float64Array) -> Float64Array:
    """(m,): twice the areas of the UV triangles, below 0 for mirrored ones."""
    a, b, c = np.moveaxis(uvs[faces], 1, 0)
    s, t = b - a, c - a
    areas: Float64Array = s[:, 0] * t[:, 1] - s[:, 1] * t[:, 0]
    return areas
