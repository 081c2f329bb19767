"""Tangents of vertices, for normal maps: those of MikkTSpace but for how faces are grouped.

Around a vertex the directions in which u grows are averaged by the angles of the faces' corners,
all within the plane of its normal (Mikkelsen, "Simulation of Wrinkled Surfaces Revisited", 2008).
MikkTSpace averages over faces that edges connect; here it is all that share the vertex.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.core.arrays import Float32Array, Float64Array
from nispcodec.io.write.vertices import Vertices


def without_mirrors(vertices: Vertices) -> Vertices:
    """The vertices, double where faces meet whose textures are mirrored and faces where not."""
    corners = 2 * vertices.faces.astype(np.int64) + (_turns(vertices) < 0)[:, None]
    used, faces = np.unique(corners, return_inverse=True)
    rows = used // 2
    return replace(
        vertices,
        positions=vertices.positions[rows],
        uvs=vertices.uvs[rows],
        normals=vertices.normals[rows],
        faces=faces.reshape(-1, 3).astype(np.uint32),
        sources=vertices.sources[rows],
    )


def tangents(vertices: Vertices) -> Float32Array:
    """(n, 4) float32: unit tangents at right angles to the normals, and the side of the bitangent.

    As glTF has them: the bitangent, in whose direction v grows upwards in the image, is
    cross(normal, tangent) times the fourth number, 1 or -1.
    """
    corners, normals = vertices.positions[vertices.faces], vertices.normals[vertices.faces]
    along = _unit(_flat(_along(vertices)[:, None], normals))
    after = _unit(_flat(np.roll(corners, -1, axis=1) - corners, normals))
    before = _unit(_flat(np.roll(corners, 1, axis=1) - corners, normals))
    angles = np.arccos(np.clip((after * before).sum(axis=2), -1, 1))
    flat, count = vertices.faces.ravel(), len(vertices.positions)
    weighted = (along * angles[..., None]).reshape(-1, 3)
    sums = [np.bincount(flat, weighted[:, axis], minlength=count) for axis in range(3)]
    found = _flat(np.stack(sums, axis=1), vertices.normals)
    # Where nothing tells how u grows, any direction will do.
    lost = np.linalg.norm(found, axis=1) < 1e-12
    axes = np.eye(3)[np.abs(vertices.normals[lost]).argmin(axis=1)]
    found[lost] = _flat(axes, vertices.normals[lost])
    turns = np.repeat(_turns(vertices), 3) * angles.ravel()
    sides = np.where(np.bincount(flat, turns, minlength=count) < 0, -1.0, 1.0)
    return np.column_stack([_unit(found), sides]).astype(np.float32)


def _along(vertices: Vertices) -> Float64Array:
    """(m, 3): the direction on each face in which u grows while v stays; 0 where there is none."""
    a, b, c = vertices.positions[vertices.faces].transpose(1, 0, 2)
    first, second = _uv_sides(vertices)
    across = (b - a) * second[:, 1:] - (c - a) * first[:, 1:]
    return across * _turns(vertices)[:, None]


def _turns(vertices: Vertices) -> Float64Array:
    """(m,): -1 for faces whose texture is mirrored, else 1."""
    first, second = _uv_sides(vertices)
    return np.where(first[:, 0] * second[:, 1] < first[:, 1] * second[:, 0], -1.0, 1.0)


def _uv_sides(vertices: Vertices) -> tuple[Float64Array, Float64Array]:
    a, b, c = vertices.uvs.astype(np.float64)[vertices.faces].transpose(1, 0, 2)
    return b - a, c - a


def _flat(vectors: Float64Array, normals: Float32Array) -> Float64Array:
    """The vectors within the planes of unit normals."""
    return vectors - (vectors * normals).sum(axis=-1, keepdims=True) * normals


def _unit(vectors: Float64Array) -> Float64Array:
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    units: Float64Array = vectors / np.maximum(lengths, 1e-300)
    return units
