"""Edges collapsed by quadrics that heed UVs (Garland and Heckbert 1998, Hoppe 1999)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int64Array
from nispcodec.core.connectivity import cell_ids
from nispcodec.core.extras import require
from nispcodec.simplify.config import CollapseConfig
from nispcodec.simplify.meshoptimizer_call import PRUNE, fewer_triangles
from nispcodec.simplify.triangles import Triangles, distinct, joined


def collapsed(
    triangles: Triangles,
    faces: int,
    config: CollapseConfig = CollapseConfig(),
    kept: BoolArray | None = None,
) -> Triangles:
    """About `faces` triangles, as few as can be had; positions and UVs are some of the given ones.

    Bodies smaller than the error are dropped, unless together they are a notable part of the area:
    then none is, those of few faces are kept as they are, and there may be more than `faces`.
    kept: (m, 3), the corners of faces whose vertices stay.
    Raises NispError without meshoptimizer.
    """
    if faces >= len(triangles):
        return triangles
    require("meshoptimizer", extra="encode", what_for="simplifying")
    found = _simplified(triangles, faces, PRUNE, config, kept)
    if found is not None and _lost(triangles, found) <= config.notable_area:
        return found
    bodies = triangles.bodies
    cards = np.asarray(np.bincount(bodies)[bodies] <= config.card_faces)
    if cards.all():
        return triangles
    kept = None if kept is None else kept[~cards]
    rest = _simplified(triangles.only(~cards), max(faces - int(cards.sum()), 1), 0, config, kept)
    if rest is None:
        return triangles
    return joined(triangles.only(cards), rest) if cards.any() else rest


def _simplified(
    triangles: Triangles,
    faces: int,
    options: int,
    config: CollapseConfig,
    kept: BoolArray | None,
) -> Triangles | None:
    """None where no triangle is left."""
    corners = cell_ids(triangles.patches[:, None], triangles.faces, triangles.uv_faces)
    at = np.zeros(int(corners.max()) + 1, np.int64)
    at[corners] = np.arange(corners.size).reshape(corners.shape)
    found = fewer_triangles(
        corners,
        triangles.corners.reshape(-1, 3)[at],
        _attributes(triangles)[at],
        config.uv_weight,
        faces,
        options,
        None if kept is None else kept.ravel()[at],
        config.error,
    )
    # At seams faces are left with two corners in one place.
    found = at[found]
    found = found[distinct(triangles.faces.ravel()[found])]
    return _rebuilt(triangles, found) if len(found) else None


def _attributes(triangles: Triangles) -> Float64Array:
    """(3 m, 2): the UV of each corner."""
    return triangles.corner_uvs.reshape(-1, 2)


def _rebuilt(triangles: Triangles, corners: Int64Array) -> Triangles:
    """Faces of corners (k, 3), each a number of a corner among the 3 m of the given triangles."""
    face = corners[:, 0] // 3
    return replace(
        triangles,
        faces=triangles.faces.ravel()[corners],
        uv_faces=triangles.uv_faces.ravel()[corners],
        materials=triangles.materials[face],
        patches=triangles.patches[face],
        sheet=triangles.sheet[face],
        # Found anew, when vertices are where they stay.
        creases=None if triangles.creases is None else np.zeros(corners.shape, np.bool_),
    ).compact()


def _lost(before: Triangles, after: Triangles) -> float:
    """The part of the area that is gone."""
    return 1 - _area(after) / _area(before)


def _area(triangles: Triangles) -> float:
    a, b, c = np.moveaxis(triangles.corners, 1, 0)
    return max(float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()), np.finfo(float).tiny)
