"""Which bodies enclose nothing: sheets, and shells whose openings nothing closes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, IntArray
from nispcodec.geometry.bodies import Bodies
from nispcodec.geometry.config import SolidConfig
from nispcodec.geometry.nearest import NearestTriangles
from nispcodec.geometry.rays import leaves, ways_beside
from nispcodec.geometry.triangles import apart, area, normals
from nispcodec.geometry.winding import Winding

TINY = np.finfo(np.float64).tiny


def free_faces(corners: Float64Array, bodies: Bodies, config: SolidConfig) -> BoolArray:
    """Faces (m,) of bodies that enclose nothing, whatever the winding number says.

    corners (m, 3, 3), those of turned faces turned.
    """
    kept = np.flatnonzero(~bodies.spare)
    shown, body = corners[kept], bodies.body[kept]
    size = np.bincount(body, area(shown), int(bodies.body.max()) + 1)
    size = np.maximum(size, TINY)
    opening, owner = _openings(corners, bodies)
    areas = area(opening)
    all_open = np.bincount(owner, areas, len(size))
    # The others cannot be open, exposed or not: most meshes have none to ask for.
    asked = np.flatnonzero((all_open / size > config.open_share)[owner])
    exposed = asked[_exposed(shown, opening[asked], config)] if len(asked) else asked
    open_area = np.bincount(owner[exposed], areas[exposed], len(size))
    is_open = open_area / size > config.open_share
    is_sheet = all_open / size > config.card_share
    rim = _Rim(opening[:, :2].mean(axis=1), owner)
    mask: BoolArray = _with_sheets(shown, body, is_sheet, is_open, rim, config)[bodies.body]
    return mask


@dataclass(frozen=True)
class _Rim:
    """The middles (n, 3) of the sides of the rim, and the bodies (n,) that they are of."""

    middles: Float64Array
    owner: IntArray


def _exposed(corners: Float64Array, opening: Float64Array, config: SolidConfig) -> BoolArray:
    """Which openings (n, 3, 3) are large and not plugged by another body.

    Closing one, as the winding number does where it passes 1/2, would draw a closing surface that
    nobody modeled. Openings beside the mesh (flat cards, panels) need no such care.
    """
    center = opening.mean(axis=1)
    number = Winding(*apart(corners), config.winding).at(center)
    exposed: BoolArray = np.abs(np.abs(number) - 0.5) < config.undecided
    # Where shells are stacked, their neighbors decide the number, and close nothing.
    clear = _gap(corners, center) > config.plugged_gap
    asked = np.flatnonzero(~exposed & clear)
    share = _escaping(corners, center[asked], -normals(opening[asked]), config)
    exposed[asked] = share > config.escape
    return exposed & clear


def _with_sheets(
    corners: Float64Array,
    body: IntArray,
    sheet: BoolArray,
    free: BoolArray,
    rim: _Rim,
    config: SolidConfig,
) -> BoolArray:
    """The `free` bodies (b,) and the sheets among the others that close nothing.

    The winding number beside a sheet is a half and whatever its neighbors add: where there are many
    (leaves), any number. Beside one that closes a body it is a whole one; beside stacked sheets it
    may be too, but from there one sees out, or at least past a rim that touches nothing. Those let
    go show others.
    """
    while (sheet & ~free).any():
        faces = np.flatnonzero((sheet & ~free)[body])
        sizes, shown = area(corners[faces]), corners[faces]
        in_front = shown.mean(axis=1) + config.probe_offset * normals(shown)
        others = corners[~free[body]]
        front = Winding(*apart(others), config.winding).at(in_front)
        total = np.maximum(np.bincount(body[faces], sizes, len(free)), TINY)
        mean = np.bincount(body[faces], front * sizes, len(free)) / total
        loose = np.abs(mean + 0.5) < 0.5 - config.closing
        loose &= sheet & ~free
        if not loose.any():
            side = np.where(mean < -0.5, 1.0, -1.0)[body[faces]]
            out = _seen_out(others, shown, body[faces], side, len(free), config)
            loose = out > config.escape
            if not loose.any():
                loose = _hanging(corners, body, free, out > config.leak, rim, config)
        if not loose.any():
            break
        free = free | loose
    return free


def _hanging(
    corners: Float64Array,
    body: IntArray,
    free: BoolArray,
    asked: BoolArray,
    rim: _Rim,
    config: SolidConfig,
) -> BoolArray:
    """Of bodies (b,) that are asked for, those whose rim is hardly anywhere near others."""
    hanging = np.zeros(len(free), dtype=bool)
    for name in np.flatnonzero(asked):
        others = corners[~free[body] & (body != name)]
        own = rim.middles[rim.owner == name]
        apart = _gap(others, own) > config.plugged_gap if len(others) else np.ones(len(own), bool)
        hanging[name] = apart.mean() > config.hanging
    return hanging


def _seen_out(
    others: Float64Array,
    shown: Float64Array,
    body: IntArray,
    side: Float64Array,
    count: int,
    config: SolidConfig,
) -> Float64Array:
    """Of bodies (count,) the share of rays from their faces, on a side each, that meet nothing.

    0 for those without faces.
    """
    random = np.random.default_rng(0)
    # The same number of each body's faces, large ones more often.
    weight = np.cumsum(area(shown)[order := np.argsort(body, kind="stable")])
    asked, first = np.unique(body[order], return_index=True)
    low = np.where(first > 0, weight[first - 1], 0.0)
    high = np.append(low[1:], weight[-1])
    at = low[:, None] + (high - low)[:, None] * random.random((len(asked), config.rays))
    face = order[np.minimum(np.searchsorted(weight, at.ravel(), side="right"), len(order) - 1)]
    facing = side[face, None] * normals(shown[face])
    start = shown[face].mean(axis=1) + config.probe_offset * facing
    escaped = leaves(others, start, ways_beside(facing, random))
    found = np.zeros(count)
    found[asked] = escaped.reshape(len(asked), -1).mean(axis=1)
    return found


def _escaping(
    corners: Float64Array, points: Float64Array, facing: Float64Array, config: SolidConfig
) -> Float64Array:
    """The share (n,) of rays from points (n, 3), about the way (n, 3) they face, that get away."""
    random = np.random.default_rng(0)
    ways = ways_beside(np.repeat(facing, config.rays, axis=0), random)
    escaped = leaves(corners, np.repeat(points, config.rays, axis=0), ways)
    return escaped.reshape(len(points), config.rays).mean(axis=1)


def _gap(corners: Float64Array, points: Float64Array) -> Float64Array:
    if not len(points):
        return np.zeros(0)
    return NearestTriangles(corners).closest(points).distances


def _openings(corners: Float64Array, bodies: Bodies) -> tuple[Float64Array, IntArray]:
    """Fan triangles (n, 3, 3) that close every loop of the rim, and their bodies (n,)."""
    first = corners.reshape(-1, 3)[bodies.rim]
    second = np.roll(corners, -1, axis=1).reshape(-1, 3)[bodies.rim]
    owner, loop = bodies.body[bodies.rim // 3], bodies.loops
    size = np.maximum(np.bincount(loop), 1)[:, None] if len(loop) else np.ones((1, 1))
    middle = np.stack([np.bincount(loop, weights=first[:, a]) for a in range(3)], axis=1) / size
    return np.stack([first, second, middle[loop]], axis=1), owner
