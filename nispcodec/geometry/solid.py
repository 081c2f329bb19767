"""The part of a mesh that a signed distance can hold: hidden faces dropped, sheets thickened.

Real assets are many bodies pushed into each other, with holes where nobody looks. The winding
number says what is inside; the part of the mesh that lies inside other bodies is hidden and cannot
be the zero set of any SDF; open surfaces (cards, cloth, leaves) have no inside and get a thickness,
as do walls too thin for one (double-sided sheets: two faces back to back).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import igl
import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int64Array, IntArray
from nispcodec.core.errors import MeshError
from nispcodec.geometry.config import SolidConfig
from nispcodec.geometry.reach import reach_of, rim_points, shared_corners
from nispcodec.geometry.welding import Welding
from nispcodec.geometry.z_order import in_space_order

TINY = np.finfo(np.float64).tiny


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


def build_solid(
    corners: Float64Array, welding: Welding, config: SolidConfig = SolidConfig()
) -> Solid:
    """Sort the faces of a mesh by what a signed distance can hold.

    corners (m, 3, 3): every face's corners, normalized frame; `welding` is that of the mesh.
    Raises MeshError when no face can be seen from outside.
    """
    free = _free_bodies(corners, welding, config)
    bodies = corners[~free]
    winding = Winding(bodies, config.winding_accuracy, config.rough_accuracy, config.rough_margin)
    pieces, parents, kind, front, whole = _classify(winding, bodies, np.flatnonzero(~free), config)
    hidden = kind == _HIDDEN
    total, hidden_area = area(corners).sum(), area(pieces[hidden]).sum()
    all_pieces = np.concatenate([pieces[~hidden], corners[free]])
    if not len(all_pieces):
        raise MeshError(f"expected faces to be seen from outside, found {len(corners)} hidden ones")
    kinds = np.concatenate([kind[~hidden], np.full(free.sum(), _OPEN)])
    open_surface = kinds != _OUTER
    open_area, front_of = area(all_pieces[open_surface]).sum(), normals(all_pieces)
    gaps = shared_corners(pieces, hidden)
    rim = rim_points(corners, welding.rim[~free[welding.rim // 3]], config.rim_step)
    whole &= kind == _OUTER
    reach = np.zeros(len(pieces))
    reach[whole] = reach_of(pieces[whole], gaps, rim, config.gap_margin)
    return Solid(
        pieces=all_pieces,
        parents=np.concatenate([parents[~hidden], np.flatnonzero(free)]),
        normals=front_of,
        open_surface=open_surface,
        wall=kinds != _OPEN,
        winding=winding,
        inside_front=np.concatenate([np.abs(front[~hidden]) > 0.5, np.zeros(free.sum(), bool)]),
        reach=np.concatenate([reach[~hidden], np.zeros(free.sum())]),
        half_thickness=config.half_thickness,
        hidden_share=float(hidden_area / total),
        open_surface_share=float(open_area / total),
    )


def area(triangles: Float64Array) -> Float64Array:
    """The areas (n,) of triangles (n, 3, 3)."""
    doubled: Float64Array = np.linalg.norm(_cross(triangles), axis=1)
    return doubled / 2


def normals(triangles: Float64Array) -> Float64Array:
    """The unit normals (n, 3) of triangles (n, 3, 3); 0 for degenerate ones."""
    cross = _cross(triangles)
    length = np.linalg.norm(cross, axis=1, keepdims=True)
    return np.divide(cross, length, out=np.zeros_like(cross), where=length > 0)


class Winding:
    """Generalized winding number of a triangle soup (m, 3, 3), by libigl.

    Fast winding numbers (Barill et al. 2018): `accuracy` is how many radii away a cluster of
    triangles is taken as one, `rough` and `margin` how many are enough where that is clear.
    """

    def __init__(
        self, bodies: Float64Array, accuracy: float, rough: float = 0.0, margin: float = 0.0
    ) -> None:
        self._accuracy, self._rough, self._margin = accuracy, rough or accuracy, margin
        self._tree = igl.FastWindingNumberBVH()
        self._empty = not len(bodies)
        if not self._empty:
            faces = np.arange(3 * len(bodies), dtype=np.int64).reshape(-1, 3)
            self._tree.init(np.ascontiguousarray(bodies.reshape(-1, 3)), faces)

    def at(self, points: Float64Array) -> Float64Array:
        """The winding number (n,) at points (n, 3); 0 everywhere for a soup of no triangles."""
        if self._empty or not len(points):
            return np.zeros(len(points))
        return in_space_order(partial(self._asked, self._accuracy), points)

    def about(self, points: Float64Array) -> Float64Array:
        """The same, only roughly except near a half, one and a half and so on: which side it is."""
        if self._empty or not len(points):
            return np.zeros(len(points))
        return in_space_order(self._about, points)

    def _about(self, points: Float64Array) -> Float64Array:
        number = self._asked(self._rough, points)
        unclear = np.flatnonzero(np.abs(number - np.floor(number) - 0.5) < self._margin)
        number[unclear] = self._asked(self._accuracy, points[unclear])
        return number

    def _asked(self, accuracy: float, points: Float64Array) -> Float64Array:
        number: Float64Array = self._tree.winding_number(points, accuracy)
        return number


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


def _free_bodies(corners: Float64Array, welding: Welding, config: SolidConfig) -> BoolArray:
    """Faces (m,) of bodies that enclose nothing, whatever the winding number says."""
    body = welding.bodies
    size = np.maximum(np.bincount(body, weights=area(corners)), TINY)
    opening, center, owner = _openings(corners, welding)
    exposed = _exposed(corners, center, config)
    open_area = np.bincount(owner[exposed], weights=opening[exposed], minlength=len(size))
    is_open = open_area / size > config.open_share
    all_open = np.bincount(owner, weights=opening, minlength=len(size))
    is_sheet = all_open / size > config.card_share
    mask: BoolArray = _with_sheets(corners, body, is_sheet, is_open, config)[body]
    return mask


def _exposed(corners: Float64Array, center: Float64Array, config: SolidConfig) -> BoolArray:
    """Which openings, by their centers (n, 3), are large and not plugged by another body.

    Closing one, as the winding number does where it passes 1/2, would draw a closing surface that
    nobody modeled. Openings beside the mesh (flat cards, panels) need no such care.
    """
    number = Winding(corners, config.winding_accuracy).at(center)
    undecided = np.abs(np.abs(number) - 0.5) < config.undecided
    exposed: BoolArray = undecided & (_gap(corners, center) > config.plugged_gap)
    return exposed


def _with_sheets(
    corners: Float64Array, body: IntArray, sheet: BoolArray, free: BoolArray, config: SolidConfig
) -> BoolArray:
    """The `free` bodies (b,) and the sheets among the others that close nothing.

    The winding number beside a sheet is a half and whatever its neighbors add: where there are many
    (leaves), any number. Beside one that closes a body it is a whole one. Those let go show others.
    """
    while (sheet & ~free).any():
        faces = np.flatnonzero((sheet & ~free)[body])
        sizes, shown = area(corners[faces]), corners[faces]
        in_front = shown.mean(axis=1) + config.probe_offset * normals(shown)
        front = Winding(corners[~free[body]], config.winding_accuracy).at(in_front)
        total = np.bincount(body[faces], sizes, len(free))
        mean = np.bincount(body[faces], front * sizes, len(free)) / np.maximum(total, TINY)
        loose = np.abs(mean + 0.5) < 0.5 - config.closing
        if not loose.any():
            break
        free = free | loose
    return free


def _gap(corners: Float64Array, points: Float64Array) -> Float64Array:
    if not len(points):
        return np.zeros(0)
    faces = np.arange(3 * len(corners), dtype=np.int64).reshape(-1, 3)
    vertices = np.ascontiguousarray(corners.reshape(-1, 3))
    squared: Float64Array = igl.point_mesh_squared_distance(points, vertices, faces)[0]
    return np.sqrt(squared)


def _openings(
    corners: Float64Array, welding: Welding
) -> tuple[Float64Array, Float64Array, IntArray]:
    """Fan triangles that close every loop of the rim: their areas, centers and bodies."""
    first = corners.reshape(-1, 3)[welding.rim]
    second = np.roll(corners, -1, axis=1).reshape(-1, 3)[welding.rim]
    owner, loop = np.repeat(welding.bodies, 3)[welding.rim], welding.loops
    size = np.maximum(np.bincount(loop), 1)[:, None] if len(loop) else np.ones((1, 1))
    middle = np.stack([np.bincount(loop, weights=first[:, a]) for a in range(3)], axis=1) / size
    fan = np.stack([first, second, middle[loop]], axis=1)
    return area(fan), fan.mean(axis=1), owner


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


def _cross(triangles: Float64Array) -> Float64Array:
    return np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
