"""From indexed positions and UVs to the single vertices that GLB and PLY want."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import Float32Array, Float64Array, IndexArray, Int64Array, Uint32Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.connectivity import row_ids
from nispcodec.core.creases import fan_normals

# Farther from the origin than this many times its extent, a mesh does not survive float32.
FAR = 100


@dataclass(frozen=True)
class Normals:
    """The normals that a mesh is shaded with.

    rows   (k, 3) float32, unit
    faces  (m, 3) int64, into the rows: of each corner
    """

    rows: Float32Array
    faces: Int64Array


@dataclass(frozen=True)
class Vertices:
    """Vertices with one position, one UV and one normal each, and the faces between them.

    positions  (n, 3) float64, world frame
    uvs        (n, 2) float32, origin bottom-left; (0, 0) on faces without UV
    normals    (n, 3) float32, unit
    faces      (m, 3) uint32
    sources    (n,) int64: the position of the mesh that each vertex comes from
    """

    positions: Float64Array
    uvs: Float32Array
    normals: Float32Array
    faces: Uint32Array
    sources: Int64Array


def split_vertices(mesh: TexturedMesh, faces: IndexArray, normals: Normals) -> Vertices:
    """One vertex for each position, UV and normal that `faces` (indices into mesh.faces) use."""
    pairs = mesh.faces[faces].astype(np.int64) << 32 | (mesh.uv_faces[faces].astype(np.int64) + 1)
    keys, numbers = np.unique(pairs, return_inverse=True)
    numbered = numbers.reshape(-1, 3).astype(np.int64) << 32 | normals.faces[faces]
    whole, inverse = np.unique(numbered, return_inverse=True)
    keys = keys[whole >> 32]
    padded = np.vstack([np.zeros((1, 2)), mesh.uvs])
    return Vertices(
        positions=mesh.positions[keys >> 32],
        uvs=padded[keys & 0xFFFFFFFF].astype(np.float32),
        normals=normals.rows[whole & 0xFFFFFFFF],
        faces=inverse.reshape(-1, 3).astype(np.uint32),
        sources=keys >> 32,
    )


def groups(mesh: TexturedMesh) -> Iterator[tuple[int, bool, IndexArray]]:
    """Each material that faces have, whether they have UVs, and those faces: into mesh.faces."""
    keys = mesh.face_materials * 2 + mesh.has_uv
    for key in np.unique(keys).tolist():
        yield key // 2, bool(key % 2), np.flatnonzero(keys == key)


def shading_normals(mesh: TexturedMesh) -> Normals:
    """Smooth normals of all positions; where a mesh has creases, normals that break over these."""
    if mesh.creases is None:
        return Normals(vertex_normals(mesh), mesh.faces.astype(np.int64))
    rows, faces = fan_normals(row_ids(mesh.positions)[mesh.faces], mesh.corners, mesh.creases)
    return Normals(rows.astype(np.float32), faces)


def vertex_normals(mesh: TexturedMesh) -> Float32Array:
    """Area-weighted unit normals (n, 3) float32 of the mesh's positions; +z where they cancel."""
    a, b, c = mesh.corners.transpose(1, 0, 2)
    weighted = np.cross(b - a, c - a)
    normals = np.empty_like(mesh.positions)
    for axis in range(3):
        normals[:, axis] = np.bincount(
            mesh.faces.ravel(), np.repeat(weighted[:, axis], 3), minlength=len(normals)
        )
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    up = np.tile([0.0, 0.0, 1.0], (len(normals), 1))
    np.divide(normals, lengths, out=up, where=lengths > 0)
    return up.astype(np.float32)


def origin(mesh: TexturedMesh) -> Float64Array:
    """The origin (3,) that float32 coordinates are relative to; all 0 unless the mesh is far."""
    low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    far = np.abs(mesh.positions).max() > FAR * (high - low).max()
    return (low + high) / 2 if far else np.zeros(3)
