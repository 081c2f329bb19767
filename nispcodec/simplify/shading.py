"""Which edges of simplified triangles are creases: those over which the source's normals jump."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int64Array
from nispcodec.core.connectivity import connected_components
from nispcodec.core.creases import breaking, face_normals, fan_normals, sharp_sides, side_pairs
from nispcodec.simplify.closest import Tree, unit
from nispcodec.simplify.config import CreaseConfig
from nispcodec.simplify.source import Source
from nispcodec.simplify.triangles import Triangles, side_numbers

WITHIN = np.full((3, 3), 0.2) + 0.4 * np.eye(3)
"""Points of a face, by weights of its corners, where its shading is compared."""


def shaded(source: Source, fewer: Triangles, config: CreaseConfig = CreaseConfig()) -> Triangles:
    """The triangles with creases like the source's; unchanged where nobody said which it has.

    Of several ways to find them the one whose shading is nearest to the source's: edges that turn
    sharply, or none, which take no bytes; or for each group of edges that hang together the best of
    these, of edges over which the source's normals jump, and of both.
    """
    if source.triangles.creases is None:
        return fewer
    sharp, jumping = sharp_sides(fewer.faces, fewer.corners), _jumping(source, fewer, config)
    places = np.einsum("sc,mcd->msd", WITHIN, fewer.corners)
    wanted = _normals_at(source, fewer, places)
    free = (sharp, np.zeros_like(sharp))
    mixed = _mixed(fewer, (*free, jumping, sharp | jumping), wanted)
    ways = (*free, mixed)
    errors = np.array([_shading_errors(fewer, each, wanted).sum() for each in ways])
    errors[:2] *= config.free
    return replace(fewer, creases=ways[int(errors.argmin())])


def _mixed(fewer: Triangles, ways: Sequence[BoolArray], wanted: Float64Array) -> BoolArray:
    """(m, 3): for each group of edges that hang together the way (m, 3) of the nearest shading."""
    union = np.logical_or.reduce(ways)
    starts, ends = fewer.faces[union], np.roll(fewer.faces, -1, axis=1)[union]
    count, labels = connected_components(starts, ends, len(fewer.positions))
    groups = labels[fewer.faces]
    errors = [_shading_errors(fewer, each, wanted) for each in ways]
    sums = [np.bincount(groups.ravel(), np.repeat(each, 3), count) for each in errors]
    best = np.argmin(sums, axis=0)[groups]
    return np.asarray(np.choose(best, ways))


def written_creases(welded: Triangles, config: CreaseConfig = CreaseConfig()) -> BoolArray:
    """(m, 3): the creases that a file says; none where readers find the same by themselves.

    Where nobody said any, or all but few of the edges are those that turn sharply. Edges of which
    one side is a crease are, and edges that do not turn are not. Where nothing is a crease that
    turns sharply, one edge that parts nothing says so.
    """
    nothing = np.zeros(welded.faces.shape, np.bool_)
    if welded.creases is None:
        return nothing
    turning = sharp_sides(welded.faces, welded.corners, config.flat)
    # A border has no other side here, but may have one in another part.
    numbers = side_numbers(welded.faces)
    border = np.bincount(numbers.ravel())[numbers] == 1
    creases = _of_both_sides(welded.faces, welded.creases) & (turning | border)
    differ = ((creases != sharp_sides(welded.faces, welded.corners)) & ~border).sum()
    if differ <= config.negligible * turning.sum():
        return nothing
    return creases if creases.any() else _harmless(welded)


def bent_creases(welded: Triangles, config: CreaseConfig = CreaseConfig()) -> BoolArray | None:
    """(m, 3): the creases, both sides of an edge alike, of edges that turn; None: nobody said."""
    if welded.creases is None:
        return None
    turning = sharp_sides(welded.faces, welded.corners, config.flat)
    return _of_both_sides(welded.faces, welded.creases) & turning


def _of_both_sides(faces: Int64Array, creases: BoolArray) -> BoolArray:
    """(m, 3): creases, the other sides of their edges too."""
    mine, other = side_pairs(faces)
    found = creases.ravel().copy()
    found[other[found[mine]]] = True
    return np.asarray(found.reshape(-1, 3))


def _harmless(triangles: Triangles) -> BoolArray:
    """One edge whose ends are inside the surface: faces there hang together the other way round."""
    sides = side_numbers(triangles.faces)
    counts = np.bincount(sides.ravel())[sides]
    outer = np.zeros(len(triangles.positions), np.bool_)
    odd = counts != 2
    outer[triangles.faces[odd]] = outer[np.roll(triangles.faces, -1, axis=1)[odd]] = True
    inside = ~outer[triangles.faces] & ~outer[np.roll(triangles.faces, -1, axis=1)]
    chosen = sides[inside][:1]
    return np.asarray(np.isin(sides, chosen))


def _jumping(source: Source, fewer: Triangles, config: CreaseConfig) -> BoolArray:
    """(m, 3): the edges over which the source's normals differ about as much as the faces do.

    They are looked up a little away from the edge, where smooth shading differs by little yet.
    """
    starts, ends = fewer.corners, np.roll(fewer.corners, -1, axis=1)
    along = np.asarray(config.along)[:, None]
    points = (1 - along) * starts[:, :, None] + along * ends[:, :, None]
    points += config.inset * (np.roll(fewer.corners, -2, axis=1)[:, :, None] - points)
    sides = _normals_at(source, fewer, points.reshape(len(fewer), -1, 3))
    sides = sides.reshape(-1, len(along), 3)
    pairs = mine, other = side_pairs(fewer.faces)
    normals = face_normals(fewer.corners)
    turns = _angle(normals[mine // 3], normals[other // 3])
    # Along an edge, what is first for one face is last for the other.
    jumps = _angle(sides[mine], sides[other][:, ::-1]).mean(axis=1)
    alike = (jumps < config.jump * turns) | (turns < config.flat)
    return breaking(pairs, alike, len(fewer))


def _normals_at(source: Source, fewer: Triangles, points: Float64Array) -> Float64Array:
    """The source's normals at points (m, k, 3) on the faces: (m, k, 3), unit."""
    hits = source.tree.closest(points.reshape(-1, 3))
    found = unit(hits.interpolate(source.corner_normals)).reshape(points.shape)
    # Of a sheet the nearest face may be that of the back.
    away = (found * face_normals(fewer.corners)[:, None]).sum(axis=2, keepdims=True) < 0
    return np.where(away, -found, found)


def _shading_errors(fewer: Triangles, creases: BoolArray, wanted: Float64Array) -> Float64Array:
    """(m,): angles of the normals at WITHIN in each face with those wanted (m, 3, 3), by area."""
    rows, fans = fan_normals(fewer.faces, fewer.corners, creases)
    shown = np.einsum("sc,mcd->msd", WITHIN, rows[fans])
    shown /= np.maximum(np.linalg.norm(shown, axis=2, keepdims=True), np.finfo(np.float64).tiny)
    return np.asarray(_angle(shown, wanted).sum(axis=1) * Tree(fewer.corners).areas)


def _angle(first: Float64Array, second: Float64Array) -> Float64Array:
    """(..., 3), (..., 3) unit -> (...): radians."""
    return np.asarray(np.arccos(np.clip((first * second).sum(axis=-1), -1, 1)))
