"""Rays that meet the triangles of mesh parts (Embree)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import Float32Array, Float64Array, Int32Array
from nispcodec.core.extras import require


@dataclass(frozen=True)
class RayHits:
    """Where each of n rays first meets a triangle.

    distance     (n,) float32 along the ray, in lengths of its direction; infinite where it does not
    face         (n,) int32; 0 where it does not
    barycentric  (n, 3) float64: weights of the triangle's corners
    """

    distance: Float32Array
    face: Int32Array
    barycentric: Float64Array


class PartRays:
    """Triangles (f, 3, 3), any f, as `PlacedTriangles.corners` has them, from either side.

    Raises NispError without the extra `render`.
    """

    def __init__(self, corners: Float64Array) -> None:
        require("embreex", extra="render", what_for="rendering mesh parts")
        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene

        self._there = len(corners) > 0
        if not self._there:
            return
        self._embree = EmbreeScene()
        numbers = np.arange(3 * len(corners), dtype=np.int32).reshape(-1, 3)
        TriangleMesh(self._embree, corners.reshape(-1, 3).astype(np.float32), numbers)
        # The first ray makes Embree build its tree: rays are cast by several threads later.
        self._embree.run(np.zeros((1, 3), np.float32), np.ones((1, 3), np.float32))

    def cast(self, origins: Float32Array, directions: Float32Array) -> RayHits:
        """First hits of rays (n, 3), (n, 3) float32 in the triangles' frame."""
        count = len(origins)
        hits = RayHits(
            np.full(count, np.inf, np.float32), np.zeros(count, np.int32), np.zeros((count, 3))
        )
        if not self._there or not count:
            return hits
        found = self._embree.run(origins, directions, output=True)
        met = np.flatnonzero(found["primID"] >= 0)
        u, v = found["u"][met].astype(np.float64), found["v"][met].astype(np.float64)
        hits.distance[met] = found["tfar"][met]
        hits.face[met] = found["primID"][met]
        hits.barycentric[met] = np.stack([1 - u - v, u, v], axis=1)
        return hits
