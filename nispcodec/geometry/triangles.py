"""Areas, normals and volumes of triangles."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float64Array, Int64Array


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


def apart(triangles: Float64Array) -> tuple[Float64Array, Int64Array]:
    """Triangles (n, 3, 3) as vertices (3 n, 3) and faces (n, 3), which share no vertex."""
    vertices = np.ascontiguousarray(triangles.reshape(-1, 3))
    return vertices, np.arange(len(vertices), dtype=np.int64).reshape(-1, 3)


def _cross(triangles: Float64Array) -> Float64Array:
    return np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
