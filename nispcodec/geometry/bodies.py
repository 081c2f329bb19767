"""Which faces make one body, and which way round they are: a mesh as people have it, put in order.

Modeling tools do not mind which way round a face is wound, some write every face twice, once each
way round, and rounding leaves seams open. The winding number minds all of that. Faces are joined by
edges: bodies that touch in one vertex are two.
"""

from __future__ import annotations

from dataclasses import dataclass

import igl
import numpy as np
from scipy.spatial import cKDTree

from nispcodec.core.arrays import BoolArray, Float64Array, Int32Array, Int64Array, IntArray
from nispcodec.core.connectivity import (
    cell_ids,
    connected_components,
    connected_faces,
    edge_ids,
    row_ids,
)
from nispcodec.geometry.config import SolidConfig
from nispcodec.geometry.pieces import against_neighbors
from nispcodec.geometry.triangles import TINY, apart, area, bulge, lattice, turn
from nispcodec.geometry.winding import Winding


@dataclass(frozen=True)
class Bodies:
    """The bodies of a mesh of m faces.

    body       (m,) int32: faces that edges connect share a number, from 0 up
    turned     (m,) bool: faces to be turned: neighbors are then wound alike, closed bodies outwards
    spare      (m,) bool: faces that are there already, whichever way round
    two_sided  (m,) bool: faces that are there the other way round as well
    unclear    (m,) bool: faces of which nothing tells whether they or their neighbors are wrong
    rim        (b,) int64, into the 3 m sides of faces, once turned, each from a corner to the next:
               those that no side of another face cancels; none of spare faces
    loops      (b,) int32: sides of the rim that corners of one body connect share a number
    welded     how many positions were joined across gaps that rounding does not explain
    """

    body: Int32Array
    turned: BoolArray
    spare: BoolArray
    two_sided: BoolArray
    unclear: BoolArray
    rim: Int64Array
    loops: Int32Array
    welded: int


def find_bodies(
    corners: Float64Array, positions: Int64Array, config: SolidConfig = SolidConfig()
) -> Bodies:
    """The bodies of faces with corners (m, 3, 3), normalized frame.

    positions (m, 3) are the same numbers, from 0 up, for the same positions.
    """
    sheet = _single(positions)
    places, welded = _seams_welded(corners, positions, sheet, config)
    places = _unrounded(corners, positions, places, config)
    if places is not positions:
        sheet = _single(places)
    flipped, unclear = _flipped(corners[sheet.faces], sheet, config)
    names = connected_components(*_neighbors(sheet.edge), len(sheet.faces))[1]
    flipped ^= against_neighbors(corners[sheet.faces], flipped, _open_sides(sheet), names, config)
    flipped ^= _inside_out(turn(corners[sheet.faces], flipped), sheet, flipped, names, config)
    chosen, turned = _chosen(sheet, flipped)
    spare = np.ones(len(corners), dtype=bool)
    spare[chosen] = False
    spare[sheet.flat] = False
    body = np.zeros(len(corners), dtype=np.int32)
    body[~sheet.flat] = names[sheet.group]
    body[sheet.flat] = names.max(initial=-1) + 1 + np.arange(sheet.flat.sum())
    two_sided, doubtful = np.zeros((2, len(corners)), dtype=bool)
    two_sided[~sheet.flat] = (np.abs(sheet.surplus) < sheet.size)[sheet.group]
    doubtful[chosen] = unclear
    ordered = np.where(turned[chosen, None], places[chosen][:, [0, 2, 1]], places[chosen])
    rim, loops = _rim(ordered, sheet, names, np.array_equal(ordered, sheet.places))
    sides = 3 * chosen[rim // 3] + rim % 3
    return Bodies(body, turned, spare, two_sided, doubtful, sides, loops, welded)


def sentences(bodies: Bodies, sizes: Float64Array, sheet: BoolArray) -> tuple[str, ...]:
    """Sentences on what was done about faces of areas (m,); those of a `sheet` have no inside."""
    total = max(float(sizes.sum()), TINY)

    def share(chosen: BoolArray) -> str:
        return f"{float(sizes[chosen].sum()) / total:.2%} of the area"

    told = []
    if bodies.turned.any():
        told.append(f"turned faces that were wound against their neighbors: {share(bodies.turned)}")
    repeated = bodies.spare & bodies.two_sided & ~sheet
    if repeated.any():
        told.append(f"took faces once that are there both ways round: {share(repeated)}")
    if bodies.welded:
        told.append(f"closed seams that stood open: {bodies.welded:,} positions")
    if bodies.unclear.any():
        told.append(f"could not tell which way round faces are: {share(bodies.unclear)}")
    return tuple(told)


@dataclass(frozen=True)
class _Single:
    """The f faces that differ, of m: repeats and faces without three places are left out.

    faces    (f,) int64: the first face of each that are the same, but for which way round
    places   (f, 3) int64: their welded positions
    group    (m - ...,) int64: of each face with three places, which of the f it is
    forward  (m - ...,) bool: and which way round
    flat     (m,) bool: faces without three places
    surplus  (f,) int64: how many more faces are as the first than the other way round
    size     (f,) int64: how many faces are the same
    edge     (3 f,) int64: the edge of each side, from 0 up
    along    (3 f,) int64: 1 or -1, which way the side runs
    """

    faces: Int64Array
    places: Int64Array
    group: Int64Array
    forward: BoolArray
    flat: BoolArray
    surplus: Int64Array
    size: Int64Array
    edge: Int64Array
    along: Int64Array


def _single(places: Int64Array) -> _Single:
    following = np.roll(places, -1, axis=1)
    flat = (places == following).any(axis=1)
    sound = np.flatnonzero(~flat)
    # Of three different numbers, one or two are followed by a higher one.
    forward = (places < following)[sound].sum(axis=1) == 2
    group = row_ids(np.sort(places[sound], axis=1))
    first = np.unique(group, return_index=True)[1]
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    group, first = rank[group], first[order]
    alike = np.where(forward == forward[first][group], 1, -1)
    surplus = np.bincount(group, alike, len(first)).astype(np.int64)
    kept = sound[first]
    edge, along = edge_ids(places[kept])
    size = np.bincount(group, minlength=len(first))
    return _Single(kept, places[kept], group, forward, flat, surplus, size, edge, along)


def _unrounded(
    corners: Float64Array, positions: Int64Array, places: Int64Array, config: SolidConfig
) -> Int64Array:
    """The places, those joined whose positions rounding alone holds apart: copies have such."""
    at = np.unique(positions, return_index=True)[1]
    pairs = _near(corners.reshape(-1, 3)[at], config.gap, config.partners)
    return _joined(places, places.reshape(-1)[at][pairs])


def _near(spots: Float64Array, distance: float, most: int) -> Int64Array:
    """(k, 2): the spots (n, 3) closer than that to each, at most so many of the nearest.

    Not all of them: beside a far outlier a whole asset is closer, each spot to every other.
    """
    _, found = cKDTree(spots).query(spots, range(1, most + 2), distance_upper_bound=distance)
    one, which = np.nonzero((found < len(spots)) & (found != np.arange(len(spots))[:, None]))
    return np.stack([one, found[one, which]], axis=1)


def _joined(positions: Int64Array, pairs: Int64Array) -> Int64Array:
    """The positions, those joined whose numbers are pairs (k, 2)."""
    if not len(pairs):
        return positions
    count = int(positions.max()) + 1
    numbers = connected_components(pairs[:, 0], pairs[:, 1], count)[1]
    return numbers.astype(np.int64)[positions]


def _seams_welded(
    corners: Float64Array, positions: Int64Array, sheet: _Single, config: SolidConfig
) -> tuple[Int64Array, int]:
    """The positions, those near each other at rims joined, and how many of these had a gap."""
    sides = _open_sides(sheet)
    if not len(sides):
        return positions, 0
    face, corner = np.divmod(sides, 3)
    ends = np.stack([corner, (corner + 1) % 3], axis=1)
    name, at = np.unique(sheet.places[face[:, None], ends], return_index=True)
    spots = corners[sheet.faces[face[:, None]], ends].reshape(-1, 3)[at]
    pairs = _near(spots, config.weld, config.partners)
    if not len(pairs):
        return positions, 0
    gaps = np.linalg.norm(spots[pairs[:, 0]] - spots[pairs[:, 1]], axis=1)
    return _joined(positions, name[pairs]), len(np.unique(pairs[gaps > config.gap]))


def _open_sides(sheet: _Single) -> Int64Array:
    """Those of the 3 f sides whose edges are of one face."""
    return np.flatnonzero(np.bincount(sheet.edge)[sheet.edge] == 1)


def _neighbors(edge: Int64Array) -> tuple[Int64Array, Int64Array]:
    """The faces on either side of edges, of sides with edges (3 f,); in a chain where several."""
    order = np.argsort(edge, kind="stable")
    together = edge[order[1:]] == edge[order[:-1]]
    face = order // 3
    return face[:-1][together], face[1:][together]


def _flipped(
    corners: Float64Array, sheet: _Single, config: SolidConfig
) -> tuple[BoolArray, BoolArray]:
    """Which of the f faces, with corners (f, 3, 3), are the wrong way round, and which unclear."""
    wrong, unclear = np.zeros(len(corners), dtype=bool), np.zeros(len(corners), dtype=bool)
    count, balance = np.bincount(sheet.edge), np.bincount(sheet.edge, sheet.along)
    crooked = (((count == 2) & (balance != 0))[sheet.edge]).reshape(-1, 3).any(axis=1)
    crooked |= np.abs(sheet.surplus) < sheet.size
    if not crooked.any():
        return wrong, unclear
    # Of patches that have such a face, all: those without keep as they are.
    ordered, patch = igl.bfs_orient(sheet.places)
    patch = np.asarray(patch, dtype=np.int64).reshape(-1)
    asked = (np.bincount(patch, crooked) > 0)[patch]
    wrong = asked & (np.asarray(ordered) != sheet.places).any(axis=1)
    sizes = area(corners)
    votes = np.where(wrong, -sizes, sizes) * sheet.surplus / sheet.size
    won = np.bincount(patch, votes) / np.maximum(np.bincount(patch, sizes), TINY)
    wrong ^= asked & (won < 0)[patch]
    held, border = bulge(turn(corners, wrong), patch), _has_border(sheet, wrong, patch)
    inward = held < np.where(border, -config.bulge, 0.0)
    for name in np.unique(patch[asked & inward[patch]]):
        of_it = patch == name
        if not _is_cavity(corners, of_it, config):
            wrong ^= of_it
    decided = ~border | (np.abs(held) > config.bulge) | (np.abs(won) > config.clear_majority)
    unclear = asked & ~decided[patch]
    return wrong, unclear & (np.abs(sheet.surplus) == sheet.size)


def _inside_out(
    corners: Float64Array,
    sheet: _Single,
    wrong: BoolArray,
    body: IntArray,
    config: SolidConfig,
) -> BoolArray:
    """Which of the f faces, with corners (f, 3, 3), are of bodies that are inside out.

    Only where these meet others, which they would take away from: alone, what they enclose is
    inside for whatever way round, and within others they are cavities. `wrong` faces are turned
    already.
    """
    found = np.zeros(len(corners), dtype=bool)
    border = _has_border(sheet, wrong, body)
    inward = bulge(corners, body) < np.where(border, -config.bulge, 0.0)
    if not inward.any() or len(inward) < 2:
        return found
    # As they all will be: of two that are inside out, each would take the other away.
    outward = turn(corners, inward[body])
    for name in np.flatnonzero(inward):
        of_it = body == name
        share = _share_inside(corners[of_it], outward[~of_it], config)
        if config.crossing < share < 1 - config.crossing:
            found |= of_it
    return found


def _share_inside(corners: Float64Array, others: Float64Array, config: SolidConfig) -> float:
    """The part of the area of faces (k, 3, 3) that lies inside others."""
    # The middles of a few large faces tell little.
    rows = int(np.ceil(np.sqrt(config.crossing_points / len(corners))))
    points = lattice(corners, rows)
    number = Winding(*apart(others), config.winding).at(points.reshape(-1, 3))
    inside = (number > 0.5).reshape(points.shape[:2]).mean(axis=1)
    return float(np.average(inside, weights=area(corners)))


def _has_border(sheet: _Single, wrong: BoolArray, patch: IntArray) -> BoolArray:
    """Of patches, whether some of their edges are not those of two sides that run against."""
    along = np.where(np.repeat(wrong, 3), -sheet.along, sheet.along)
    count, balance = np.bincount(sheet.edge), np.bincount(sheet.edge, along)
    bad = ((count != 2) | (balance != 0))[sheet.edge]
    border: BoolArray = np.bincount(np.repeat(patch, 3), bad) > 0
    return border


def _is_cavity(corners: Float64Array, chosen: BoolArray, config: SolidConfig) -> bool:
    """Whether most of the chosen faces lie inside what the others make."""
    number = Winding(*apart(corners[~chosen]), config.winding).at(corners[chosen].mean(axis=1))
    return bool(np.average(np.abs(number) > 0.5, weights=area(corners[chosen])) > 0.5)


def _chosen(sheet: _Single, flipped: BoolArray) -> tuple[Int64Array, BoolArray]:
    """The faces (f,) that stay of those that are the same, and which (m,) are to be turned.

    One that is the right way round already, where there is one: it has the UVs of that side.
    """
    turned = np.zeros(len(sheet.flat), dtype=bool)
    if (sheet.size == 1).all():
        turned[sheet.faces[flipped]] = True
        return sheet.faces, turned
    first = np.searchsorted(np.flatnonzero(~sheet.flat), sheet.faces)
    wanted = sheet.forward[first] ^ flipped
    agrees = sheet.forward == wanted[sheet.group]
    order = np.lexsort([~agrees, sheet.group])
    best = order[np.searchsorted(sheet.group[order], np.arange(len(sheet.faces)))]
    chosen = np.flatnonzero(~sheet.flat)[best]
    turned[chosen] = ~agrees[best]
    return chosen, turned


def _rim(
    places: Int64Array, sheet: _Single, body: IntArray, as_given: bool
) -> tuple[Int64Array, Int32Array]:
    """Sides (b,) of faces with positions (f, 3) that no other side cancels, and their loops."""
    edge, along = (sheet.edge, sheet.along) if as_given else edge_ids(places)
    sides = np.flatnonzero(np.bincount(edge, along)[edge] != 0) if len(edge) else edge
    if not len(sides):
        return sides, np.zeros(0, dtype=np.int32)
    face, corner = np.divmod(sides, 3)
    ends = np.stack([places[face, corner], places[face, (corner + 1) % 3]], axis=1)
    names = cell_ids(body[face][:, None], ends)
    return sides, connected_faces(names[:, [0, 1, 0]])
