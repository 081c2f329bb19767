"""Areas, normals and volumes of triangles."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int64Array, IntArray

TINY = float(np.finfo(np.float64).tiny)


def area(triangles: Float64Array) -> Float64Array:
    """The areas (n,) of triangles (n, 3, 3)."""
    doubled: Float64Array = np.linalg.norm(_cross(triangles), axis=1)
    return doubled / 2


def normals(triangles: Float64Array) -> Float64Array:
    """The unit normals (n, 3) of triangles (n, 3, 3); 0 for degenerate ones."""
    cross = _cross(triangles)
    length = np.linalg.norm(cross, axis=1, keepdims=True)
    return np.divide(cross, length, out=np.zeros_like(cross), where=length > 0)


def volumes(triangles: Float64Array) -> Float64Array:
    """Signed volumes (n,) between the origin and triangles (n, 3, 3).

    Those of a closed surface add up to what it encloses, positive where its normals point outwards.
    """
    a, b, c = triangles.transpose(1, 0, 2)
    sixfold: Float64Array = np.einsum("nx,nx->n", a, np.cross(b, c))
    return sixfold / 6


def turn(corners: Float64Array, turned: BoolArray) -> Float64Array:
    """Faces (m, 3, 3), those `turned` with their last two corners swapped."""
    if not turned.any():
        return corners
    return np.where(turned[:, None, None], corners[:, [0, 2, 1]], corners)


def bulge(corners: Float64Array, patch: IntArray) -> Float64Array:
    """The volume behind each patch for its area^1.5; a sphere has 0.09, a plane 0."""
    sizes, middles = area(corners), corners.mean(axis=1)
    total = np.maximum(np.bincount(patch, sizes), TINY)
    center = np.stack([np.bincount(patch, sizes * middles[:, a]) / total for a in range(3)], axis=1)
    enclosed = np.bincount(patch, volumes(corners - center[patch][:, None]))
    found: Float64Array = enclosed / total**1.5
    return found


def lattice(triangles: Float64Array, rows: int) -> Float64Array:
    """(n, rows^2, 3): the middles of the equal parts that triangles (n, 3, 3) fall into."""
    i, j = (each.ravel() for each in np.indices((rows, rows)))
    # Beyond the diagonal lie the parts that stand on their heads, mirrored into the triangle.
    upright = i + j < rows
    u = np.where(upright, i + 1 / 3, rows - i - 1 / 3) / rows
    v = np.where(upright, j + 1 / 3, rows - j - 1 / 3) / rows
    found: Float64Array = np.einsum("kc,ncx->nkx", np.stack([1 - u - v, u, v], axis=1), triangles)
    return found


def apart(triangles: Float64Array) -> tuple[Float64Array, Int64Array]:
    """Triangles (n, 3, 3) as vertices (3 n, 3) and faces (n, 3), which share no vertex."""
    vertices = np.ascontiguousarray(triangles.reshape(-1, 3))
    return vertices, np.arange(len(vertices), dtype=np.int64).reshape(-1, 3)


def _cross(triangles: Float64Array) -> Float64Array:
    return np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
