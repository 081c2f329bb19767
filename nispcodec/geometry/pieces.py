"""Bodies that are pieces of one, with seams that stand open: which of them are inside out."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from nispcodec.core.arrays import BoolArray, Float64Array, Int64Array, IntArray
from nispcodec.core.connectivity import connected_components
from nispcodec.geometry.config import SolidConfig
from nispcodec.geometry.triangles import TINY, bulge, turn


def against_neighbors(
    corners: Float64Array,
    flipped: BoolArray,
    sides: Int64Array,
    body: IntArray,
    config: SolidConfig,
) -> BoolArray:
    """Which of f faces (f,) are of pieces that are wound against those beyond an open seam.

    corners (f, 3, 3), of which those `flipped` are the other way round; sides: of the 3 f sides of
    faces, as given, those of one face only; body (f,), from 0 up. Only pieces that make a body with
    an outside are turned, to look there: sheets that lie on each other have seams like that, too.
    """
    one, other, alike = _beside(corners, flipped, sides, body, config)
    if alike.all():
        return np.zeros(len(corners), dtype=bool)
    whole, turned, agreed = _sorted(one, other, alike, int(body.max()) + 1)
    chosen = turned[body]
    held = bulge(turn(corners, flipped ^ chosen), whole[body])
    mixed = np.bincount(whole, turned) > 0
    settled = mixed & agreed & (np.abs(held) > config.bulge)
    found: BoolArray = settled[whole[body]] & (chosen ^ (held < 0)[whole[body]])
    return found


def _beside(
    corners: Float64Array,
    flipped: BoolArray,
    sides: Int64Array,
    body: IntArray,
    config: SolidConfig,
) -> tuple[IntArray, IntArray, BoolArray]:
    """Pairs of bodies (k,), (k,) with sides along one seam, and whether these run against."""
    face, corner = np.divmod(sides, 3)
    start, end = corners[face, corner], corners[face, (corner + 1) % 3]
    way = np.where(flipped[face, None], start - end, end - start)
    lengths, middles = np.linalg.norm(way, axis=1), (start + end) / 2
    near = range(2, config.partners + 2)
    gaps, found = cKDTree(middles).query(middles, near, distance_upper_bound=config.seam)
    first, rank = np.nonzero(found < len(sides))
    second, gaps = found[first, rank], gaps[first, rank]
    shorter = np.minimum(lengths[first], lengths[second])
    product = np.maximum(lengths[first] * lengths[second], TINY)
    cosine = (way[first] * way[second]).sum(axis=1) / product
    one, other = body[face[first]], body[face[second]]
    chosen = (one != other) & (gaps <= config.seam_share * shorter)
    chosen &= np.abs(cosine) >= config.seam_cosine
    return one[chosen], other[chosen], cosine[chosen] < 0


def _sorted(
    one: IntArray, other: IntArray, alike: BoolArray, count: int
) -> tuple[IntArray, BoolArray, BoolArray]:
    """The whole that each of `count` bodies is a piece of, by pairs, and which to turn in it.

    And of each whole, whether its pieces agree. Each body is there twice, as it is and turned:
    pairs that are alike connect the same, others one with the other's second.
    """
    turned = np.where(alike, 0, count)
    starts = np.concatenate([one, one + count])
    ends = np.concatenate([other + turned, other + count - turned])
    names = connected_components(starts, ends, 2 * count)[1]
    as_it_is, other_way = names[:count], names[count:]
    _, whole = np.unique(np.minimum(as_it_is, other_way), return_inverse=True)
    torn = np.bincount(whole, as_it_is == other_way) > 0
    return whole, as_it_is > other_way, ~torn
