"""Rays from points of a mesh: which of them get away."""

from __future__ import annotations

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene

from nispcodec.core.arrays import BoolArray, Float64Array

TINY = np.finfo(np.float64).tiny


def ways_beside(facing: Float64Array, random: np.random.Generator) -> Float64Array:
    """Random directions (n, 3) about unit vectors, by the cosine to them."""
    way = random.normal(size=facing.shape)
    way = facing + way / np.linalg.norm(way, axis=1, keepdims=True)
    return way / np.maximum(np.linalg.norm(way, axis=1, keepdims=True), TINY)


def leaves(corners: Float64Array, points: Float64Array, ways: Float64Array) -> BoolArray:
    """Which rays (n,) meet none of the faces (m, 3, 3); in single precision.

    By Embree: libigl's rays go through triangles with sides below a thousandth.
    """
    if not len(points) or not len(corners):
        return np.ones(len(points), dtype=bool)
    scene = EmbreeScene()
    TriangleMesh(scene, corners.astype(np.float32))
    met = scene.run(points.astype(np.float32), ways.astype(np.float32), query="OCCLUDED")
    missed: BoolArray = np.asarray(met) < 0
    return missed
