"""The part of a mesh that a signed distance can hold: hidden faces dropped, sheets thickened.

Real assets are many bodies pushed into each other, with holes where nobody looks. The winding
number says what is inside; the part of the mesh that lies inside other bodies is hidden and cannot
be the zero set of any SDF; open surfaces (cards, cloth, leaves) have no inside and get a thickness,
as do walls too thin for one (double-sided sheets: two faces back to back).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int64Array
from nispcodec.core.errors import MeshError
from nispcodec.geometry.bodies import Bodies, find_bodies, sentences
from nispcodec.geometry.config import SolidConfig
from nispcodec.geometry.enclosing import free_faces
from nispcodec.geometry.reach import reach_of, rim_points, shared_corners
from nispcodec.geometry.triangles import apart, area, normals, turn
from nispcodec.geometry.welding import Welding
from nispcodec.geometry.winding import Winding


@dataclass(frozen=True)
class Solid:
    """A mesh in the normalized frame, sorted by what an SDF can hold.

    pieces         (p, 3, 3) float64: the outer faces and open surfaces, large ones subdivided
    parents        (p,) int: the mesh face that each piece is part of
    normals        (p, 3) float64: unit normals; 0 for degenerate pieces
    open_surface   (p,) bool: pieces that get a thickness
    wall           (p,) bool: pieces with an inside; an open surface that is one too is one side of
                   a double-sided sheet
    winding        winding number of the closed or nearly closed bodies: beyond 1/2 is inside
    inside_front   (p,) bool: pieces whose front is inside (inverted bodies)
    reach          (p,) float64: points whose closest piece this is are on the side that it shows
                   them if they are nearer than this; 0 where that is not known
    half_thickness given to open surfaces, normalized frame
    hidden_share, open_surface_share: shares of the mesh's area
    warnings       what was done about faces to tell their inside, in sentences
    """

    pieces: Float64Array
    parents: Int64Array
    normals: Float64Array
    open_surface: BoolArray
    wall: BoolArray
    winding: Winding
    inside_front: BoolArray
    reach: Float64Array
    half_thickness: float
    hidden_share: float
    open_surface_share: float
    warnings: tuple[str, ...]


def build_solid(
    corners: Float64Array, welding: Welding, config: SolidConfig = SolidConfig()
) -> Solid:
    """Sort the faces of a mesh by what a signed distance can hold.

    corners (m, 3, 3): every face's corners, normalized frame; `welding` is that of the mesh.
    Raises MeshError when no face can be seen from outside.
    """
    bodies = find_bodies(corners, welding.positions, config)
    faces = _in_order(corners, bodies, config)
    enclosing = faces.corners[~faces.free & faces.once]
    winding = Winding(*apart(enclosing), config.winding, often=True)
    shown = np.flatnonzero(~faces.free & ~faces.behind)
    pieces, parents, kind, front, whole = _classify(winding, faces.corners[shown], shown, config)
    seen, sheets = kind != _HIDDEN, faces.corners[faces.free]
    kept = np.concatenate([pieces[seen], sheets])
    if not len(kept):
        raise MeshError(f"expected faces to be seen from outside, found {len(corners)} hidden ones")
    kinds = np.concatenate([kind[seen], np.full(len(sheets), _OPEN)])
    reach = _reach(
        pieces, kind, whole, rim_points(faces.corners, faces.rim, config.rim_step), config
    )
    hidden = area(pieces[~seen]).sum() + area(faces.corners[faces.behind]).sum()
    total = area(faces.corners).sum()
    return Solid(
        pieces=kept,
        parents=np.concatenate([parents[seen], np.flatnonzero(faces.free)]),
        normals=normals(kept),
        open_surface=kinds != _OUTER,
        wall=kinds != _OPEN,
        winding=winding,
        inside_front=np.concatenate([np.abs(front[seen]) > 0.5, np.zeros(len(sheets), bool)]),
        reach=np.concatenate([reach[seen], np.zeros(len(sheets))]),
        half_thickness=config.half_thickness,
        hidden_share=float(hidden / total),
        open_surface_share=float(area(kept[kinds != _OUTER]).sum() / total),
        warnings=faces.warnings,
    )


@dataclass(frozen=True)
class _Faces:
    """The m faces of a mesh, turned and each in its place.

    corners   (m, 3, 3), the wrong ones turned
    free      (m,) bool: of sheets that enclose nothing
    once      (m,) bool: that enclose, without those that are there already
    behind    (m,) bool: the backs of faces of bodies
    rim       (b,) sides of faces where what encloses ends
    warnings  what was done about them
    """

    corners: Float64Array
    free: BoolArray
    once: BoolArray
    behind: BoolArray
    rim: Int64Array
    warnings: tuple[str, ...]


def _in_order(corners: Float64Array, bodies: Bodies, config: SolidConfig) -> _Faces:
    turned = turn(corners, bodies.turned)
    sheets = free_faces(turned, bodies, config)
    # Faces back to back that have no inside are two sides of a sheet, and stay so.
    two_sided = sheets & bodies.two_sided
    if (two_sided & bodies.turned).any():
        turned = turn(corners, bodies.turned & ~two_sided)
    free = sheets & ~two_sided
    once = two_sided | ~bodies.spare
    face = bodies.rim // 3
    return _Faces(
        corners=turned,
        free=free,
        once=once,
        behind=~free & ~once & bodies.two_sided,
        rim=bodies.rim[~free[face] & ~two_sided[face]],
        warnings=sentences(bodies, area(turned), sheets),
    )


def _reach(
    pieces: Float64Array, kind: Int64Array, whole: BoolArray, rim: Float64Array, config: SolidConfig
) -> Float64Array:
    """How far each piece may answer for the side of a point; 0 where it is no whole wall."""
    walls = whole & (kind == _OUTER)
    reach = np.zeros(len(pieces))
    gaps = shared_corners(pieces, kind == _HIDDEN)
    reach[walls] = reach_of(pieces[walls], gaps, rim, config.gap_margin)
    return reach


_OUTER, _HIDDEN, _OPEN, _THIN, _MIXED = range(5)


def _classify(
    winding: Winding, bodies: Float64Array, parents: Int64Array, config: SolidConfig
) -> tuple[Float64Array, Int64Array, Int64Array, Float64Array, BoolArray]:
    """Subdivide the faces until each piece is of one kind.

    Pieces, their parents, their kinds, the winding numbers in front of them, and whether those in
    front and behind are whole ones, as where nothing else is near.
    """
    done: list[tuple[Float64Array, Int64Array, Int64Array, Float64Array]] = []
    todo, todo_parents = bodies, parents
    while len(todo):
        longest = _longest_edge(todo)
        fine = longest <= config.fine_edge
        kind, front = _kind(winding, todo, fine, config)
        split = (longest > config.coarse_edge) | (kind == _MIXED)
        kind = np.where(kind == _MIXED, _OUTER, kind)
        keep = ~split | fine
        done.append((todo[keep], todo_parents[keep], kind[keep], front[keep]))
        todo, todo_parents = _subdivide(todo[~keep]), np.repeat(todo_parents[~keep], 4)
    if not done:
        return bodies, parents, parents, np.zeros(0), np.zeros(0, dtype=bool)
    pieces, owners, kind, front = (np.concatenate(each) for each in zip(*done, strict=True))
    outer = np.flatnonzero(kind == _OUTER)
    thin, behind = _thin(winding, pieces[outer], config.thin_wall)
    kind[outer[thin]] = _THIN
    whole = np.zeros(len(pieces), dtype=bool)
    off = np.abs(front[outer] - np.round(front[outer]))
    whole[outer] = (off < config.whole) & (np.abs(behind - front[outer] - 1) < config.whole)
    return pieces, owners, kind, front, whole


def _thin(winding: Winding, pieces: Float64Array, depth: float) -> tuple[BoolArray, Float64Array]:
    """Which pieces (p,) have the outside in front and, `depth` away, behind them as well.

    And the winding numbers (p,) behind them.
    """
    center, step = pieces.mean(axis=1), depth * normals(pieces)
    behind = winding.about(center - step)
    thin: BoolArray = np.abs(behind) <= 0.5
    thin[thin] = np.abs(winding.about((center + step)[thin])) <= 0.5
    return thin, behind


def _kind(
    winding: Winding, pieces: Float64Array, single: BoolArray, config: SolidConfig
) -> tuple[Int64Array, Float64Array]:
    """Kind of each piece from its centroid, and for all but the small ones from its corners too.

    And the winding number in front of the centroid.
    """
    kind, front = _point_kind(winding, pieces, np.full(3, 1 / 3), config)
    large = np.flatnonzero(~single)
    for corner in range(3):
        weights = np.full(3, 0.05)
        weights[corner] = 0.9
        other, _ = _point_kind(winding, pieces[large], weights, config)
        kind[large] = np.where(other == kind[large], other, _MIXED)
    return kind, front


def _point_kind(
    winding: Winding, pieces: Float64Array, weights: Float64Array, config: SolidConfig
) -> tuple[Int64Array, Float64Array]:
    """Across a face the winding number falls by one, so one look in front is enough.

    Not quite by one across an open surface, whose rim shows: hence the doubtful band.
    """
    points = np.einsum("c,ncx->nx", weights, pieces) + config.probe_offset * normals(pieces)
    front = winding.about(points)
    doubtful = np.abs(front + 0.5) < config.doubt
    inside = (np.abs(front) > 0.5) & (np.abs(front + 1) > 0.5)
    return np.select([doubtful, inside], [_OPEN, _HIDDEN], _OUTER), front


def _subdivide(triangles: Float64Array) -> Float64Array:
    """Each triangle into four through its edge midpoints, children of one parent together."""
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
    children = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    stacked = np.stack([np.stack(child, axis=1) for child in children], axis=1)
    return stacked.reshape(-1, 3, 3)


def _longest_edge(triangles: Float64Array) -> Float64Array:
    edges = triangles - np.roll(triangles, 1, axis=1)
    longest: Float64Array = np.linalg.norm(edges, axis=2).max(axis=1, initial=0.0)
    return longest
