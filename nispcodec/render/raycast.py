"""A triangle mesh to look at: first hits by ray casting (Embree)."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float32Array, Float64Array, Int32Array, Int64Array
from nispcodec.core.asset import Material, Texture, TexturedMesh
from nispcodec.core.document import Frame
from nispcodec.core.extras import require
from nispcodec.metrics.surface import Surface, SurfacePoints, frame_of
from nispcodec.metrics.uv import uv_at
from nispcodec.render.fragments import Cast, Fragments
from nispcodec.render.normals import corner_normals


class MeshScene:
    """A mesh in the world frame as a scene, placed by `frame`.

    That is the mesh's own by default, or the original's when it is compared with one. Raises
    MeshError for a mesh without a surface, NispError without the extra `render`. `charts` (m,) are
    those of the faces, for the channel that shows them.
    """

    def __init__(
        self, mesh: TexturedMesh, frame: Frame | None = None, charts: Int32Array | None = None
    ) -> None:
        require("embreex", "igl", extra="render", what_for="rendering a mesh")
        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene

        self.frame = frame or frame_of(mesh)
        self.surface = Surface.of(mesh, self.frame)
        self._embree = EmbreeScene()
        TriangleMesh(self._embree, self.surface.positions.astype(np.float32), mesh.faces)
        # The first ray makes Embree build its tree: rays are cast by several threads later.
        self._embree.run(np.zeros((1, 3), np.float32), np.ones((1, 3), np.float32))
        self._corner_normals = corner_normals(self.surface)
        self._jacobians = face_jacobians(self.surface)
        self._charts = np.full(len(mesh.faces), -1, np.int32) if charts is None else charts

    @property
    def materials(self) -> tuple[Material, ...]:
        """The mesh's materials."""
        return self.surface.mesh.materials

    @property
    def textures(self) -> tuple[Texture, ...]:
        """The mesh's textures."""
        return self.surface.mesh.textures

    def cast(self, origins: Float32Array, directions: Float32Array, layer: int = 0) -> Cast:
        """Cast rays (n, 3), (n, 3) at the triangles; see `Scene.cast`."""
        found = self._embree.run(origins, directions, output=True)
        rays = np.flatnonzero(found["primID"] >= 0)
        u, v = found["u"][rays].astype(np.float64), found["v"][rays].astype(np.float64)
        faces, weights = found["primID"][rays].astype(np.int64), np.stack([1 - u - v, u, v], axis=1)
        points = self._seen(faces, weights, directions[rays].astype(np.float64))
        fragments = self._fragments(rays, found["tfar"][rays], points, directions[rays])
        count = len(origins)
        return Cast(fragments, np.zeros(count, np.int32), np.zeros(count, np.bool_))

    def _seen(
        self, faces: Int64Array, weights: Float64Array, towards: Float64Array
    ) -> SurfacePoints:
        """The points that rays hit, of two faces back to back on the one that faces the ray."""
        seen = self.surface.facing(faces, towards)
        positions = self.surface.interpolate(faces, weights)
        turned = np.flatnonzero(seen != faces)
        weights[turned] = self.surface.weights(seen[turned], positions[turned])
        return SurfacePoints(seen, weights, positions)

    def _fragments(
        self,
        rays: Int64Array,
        distances: Float32Array,
        points: SurfacePoints,
        towards: Float32Array,
    ) -> Fragments:
        mesh, faces = self.surface.mesh, points.faces
        normals = np.einsum("nk,nkd->nd", points.weights, self._corner_normals[faces])
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
        return Fragments(
            rays=rays,
            distances=distances,
            normals=normals.astype(np.float32),
            facing=(self.surface.normals[faces] * towards).sum(axis=1) < 0,
            uvs=uv_at(self.surface, points).astype(np.float32),
            jacobians=self._jacobians[faces],
            materials=mesh.face_materials[faces],
            textured=mesh.has_uv[faces],
            charts=self._charts[faces],
        )


def face_jacobians(surface: Surface) -> Float32Array:
    """(m, 2, 3) float32: how u and v of each face change along x, y, z in its plane."""
    corners, uvs = surface.corners, surface.mesh.corner_uvs
    edges = corners[:, 1:] - corners[:, :1]
    uv_edges = uvs[:, 1:] - uvs[:, :1]
    jacobians = uv_edges.transpose(0, 2, 1) @ np.linalg.pinv(edges).transpose(0, 2, 1)
    return np.asarray(jacobians, dtype=np.float32)
