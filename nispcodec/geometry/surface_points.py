"""Random points on and beside the surface, and where in its triangle a point lies."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float64Array, Int64Array
from nispcodec.geometry.solid import Solid
from nispcodec.geometry.triangles import area

TINY = np.finfo(np.float64).tiny


def barycentric(triangles: Float64Array, points: Float64Array) -> Float64Array:
    """Barycentric coordinates (n, 3) of points (n, 3) in the planes of triangles (n, 3, 3).

    Those of points outside their triangle are clipped to it.
    """
    ab, ac = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    ap = points - triangles[:, 0]
    bb, bc, cc, pb, pc = (
        np.einsum("nx,nx->n", p, q) for p, q in ((ab, ab), (ab, ac), (ac, ac), (ap, ab), (ap, ac))
    )
    determinant = np.maximum(bb * cc - bc * bc, TINY)
    v, w = (cc * pb - bc * pc) / determinant, (bb * pc - bc * pb) / determinant
    a, b, c = (np.clip(each, 0.0, 1.0) for each in (1 - v - w, v, w))
    return np.stack([a, b, c], axis=1) / (a + b + c)[:, None]


def random_barycentric(random: np.random.Generator, count: int) -> Float64Array:
    """(count, 3) barycentric coordinates, uniform over a triangle (Osada et al. 2002)."""
    root = np.sqrt(random.random(count))
    second = random.random(count)
    return np.stack([1 - root, root * (1 - second), root * second], axis=1)


def uniform_surface(
    random: np.random.Generator, pieces: Float64Array, count: int
) -> tuple[Float64Array, Int64Array]:
    """Points (count, 3) uniform by area on pieces (p, 3, 3), and the piece (count,) of each."""
    return points_on(random, pieces, area(pieces), count)


def points_on(
    random: np.random.Generator, pieces: Float64Array, weight: Float64Array, count: int
) -> tuple[Float64Array, Int64Array]:
    """As `uniform_surface`, with pieces chosen by their weight (p,) in place of their area."""
    piece = random.choice(len(pieces), size=count, p=weight / weight.sum())
    weights = random_barycentric(random, count)
    return np.einsum("nc,ncx->nx", weights, pieces[piece]), piece


def solid_surface(
    random: np.random.Generator, solid: Solid, count: int
) -> tuple[Float64Array, Int64Array]:
    """Points (count, 3) uniform by area on a solid's surface, and the piece (count,) of each.

    Points on open surfaces lie where the thickness ends.
    """
    points, piece = uniform_surface(random, solid.pieces, count)
    return raised(random, solid, points, piece), piece


def raised(
    random: np.random.Generator, solid: Solid, points: Float64Array, piece: Int64Array
) -> Float64Array:
    """Points (n, 3) on pieces (n,), those on open surfaces moved to where the thickness ends.

    That is in front of one of two faces back to back, and on a random side of a single one. Changes
    `points`, and returns it.
    """
    thick = np.flatnonzero(solid.open_surface[piece])
    on = piece[thick]
    side = np.where(solid.wall[on] | (random.random(len(on)) < 0.5), 1.0, -1.0)
    points[thick] += (solid.half_thickness * side)[:, None] * solid.normals[on]
    return points


def laplace_offsets(
    random: np.random.Generator, surface: Float64Array, spread: float, limit: float
) -> Float64Array:
    """Points (k, 3) beside surface points (n, 3), whose |SDF| has the mean `spread` on a plane.

    Each moves in a random direction by a Gamma(2, spread) distance: the part of that along the
    normal is Laplace-distributed, and edges are surrounded from all sides. Points that leave the
    cube [-limit, limit]^3 are left out, so that k may be less than n.
    """
    direction = random.normal(size=surface.shape)
    length = np.sqrt(np.einsum("nx,nx->n", direction, direction))
    points = surface + direction * (random.gamma(2.0, spread, len(surface)) / length)[:, None]
    x, y, z = np.abs(points).T
    return points[(x <= limit) & (y <= limit) & (z <= limit)]


def uniform_ball(random: np.random.Generator, count: int) -> Float64Array:
    """(count, 3) points uniform in the unit ball."""
    direction = random.normal(size=(count, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    return direction * np.cbrt(random.random((count, 1)))
