"""Rays from points of a mesh: which of them get away."""

from __future__ import annotations

import igl
import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array
from nispcodec.geometry.triangles import apart

TINY = np.finfo(np.float64).tiny


def ways_beside(facing: Float64Array, random: np.random.Generator) -> Float64Array:
    """Random directions (n, 3) about unit vectors, by the cosine to them."""
    way = random.normal(size=facing.shape)
    way = facing + way / np.linalg.norm(way, axis=1, keepdims=True)
    return way / np.maximum(np.linalg.norm(way, axis=1, keepdims=True), TINY)


def leaves(corners: Float64Array, points: Float64Array, ways: Float64Array) -> BoolArray:
    """Which rays (n,) meet none of the faces (m, 3, 3)."""
    if not len(points):
        return np.zeros(0, dtype=bool)
    tree = igl.AABB()
    vertices, faces = apart(corners)
    tree.init(vertices, faces)
    hit = tree.intersect_ray_first(vertices, faces, points, ways)[0]
    missed: BoolArray = np.asarray(hit).reshape(-1) < 0
    return missed
