"""Which way the UVs of a mesh grow on its surface, as renderers see it: smooth across faces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import Float64Array, Int32Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.io.write.vertices import shading_normals


@dataclass(frozen=True)
class TangentFrames:
    """Unit directions (n, 3) on the surface, square to the smooth normal and to each other.

    tangents: u grows; bitangents: v grows, v upwards in the image as in OBJ.
    """

    tangents: Float64Array
    bitangents: Float64Array


def frames_at(mesh: TexturedMesh, faces: Int32Array, weights: Float64Array) -> TangentFrames:
    """The tangent frames at barycentric `weights` (n, 3) in `faces` (n,), all of which have UVs.

    Directions of u are averaged over the faces that share a UV and made square to the averaged
    normals, much as MikkTSpace does.
    """
    along, mirrored = _directions(mesh)
    sums = np.zeros((len(mesh.uvs), 3))
    np.add.at(sums, mesh.uv_faces.ravel(), np.repeat(along, 3, axis=0))
    shading = shading_normals(mesh)
    normals = shading.rows.astype(np.float64)[shading.faces[faces]]
    normal = _unit(np.einsum("nc,ncd->nd", weights, normals))
    tangent = np.einsum("nc,ncd->nd", weights, sums[mesh.uv_faces[faces]])
    tangent = _unit(tangent - (tangent * normal).sum(axis=1, keepdims=True) * normal)
    return TangentFrames(tangent, np.cross(normal, tangent) * mirrored[faces][:, None])


def _directions(mesh: TexturedMesh) -> tuple[Float64Array, Float64Array]:
    """Unit direction of growing u on each face (m, 3); -1 where the face is mirrored, else 1."""
    a, b, c = mesh.corners.transpose(1, 0, 2)
    first, second = (mesh.corner_uvs[:, 1:] - mesh.corner_uvs[:, :1]).transpose(1, 0, 2)
    mirrored = np.where(first[:, 0] * second[:, 1] < second[:, 0] * first[:, 1], -1.0, 1.0)
    along = (b - a) * second[:, 1:] - (c - a) * first[:, 1:]
    return _unit(along * mirrored[:, None]), mirrored


def _unit(vectors: Float64Array) -> Float64Array:
    units: Float64Array = vectors / np.maximum(
        np.linalg.norm(vectors, axis=1, keepdims=True), 1e-300
    )
    return units
