"""A field to look at without a mesh: sphere tracing; normals, charts and UVs by network."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float32Array, Int32Array, Int64Array
from nispcodec.core.asset import Material, Texture
from nispcodec.core.document import Document, Field, Frame
from nispcodec.core.extras import require
from nispcodec.infer.evaluate import gradient
from nispcodec.infer.field import FieldQueries
from nispcodec.render.fragments import Cast, Fragments
from nispcodec.render.march import March
from nispcodec.render.space import bounding_space
from nispcodec.render.tangents import tangent_axes

# How far from a point its UVs are asked, to see how they change (normalized frame).
OFFSET = np.float32(1e-3)
# A hit is moved along its ray by no more than this.
CORRECTION = 5e-4
# Where the field closes an opening of the asset there is nothing to see.
OPENING = Material("opening", base_color=(0.0, 0.0, 0.0, 0.0), alpha_mode="mask")


class FieldScene:
    """The field of a document as a scene; making one evaluates it on a grid.

    Raises NispError without the extra `render`.
    """

    def __init__(self, document: Document, field: Field) -> None:
        require("scipy", extra="render", what_for="rendering")
        self._document, self._field = document, field
        self._queries = FieldQueries(field)
        self.space = bounding_space(field.sdf, field.half_thickness)
        self._chart_materials = self._materials_of_charts()

    @property
    def frame(self) -> Frame:
        """The document's frame."""
        return self._document.frame

    @property
    def materials(self) -> tuple[Material, ...]:
        """The document's materials, and one more that is invisible, for its openings."""
        return (*self._document.materials, OPENING)

    @property
    def textures(self) -> tuple[Texture, ...]:
        """The document's textures."""
        return self._document.textures

    def _materials_of_charts(self) -> Int32Array:
        """(k,) int32: the material of each chart."""
        table = self._field.charts
        materials = table.materials.copy()
        if table.openings:
            materials[-1] = len(self.materials) - 1
        return materials

    def cast(self, origins: Float32Array, directions: Float32Array, layer: int = 0) -> Cast:
        """Cast rays (n, 3), (n, 3) by sphere tracing; see `Scene.cast`."""
        sdf = self._field.sdf
        trace = March(sdf, self.space, origins, directions, inside=layer % 2 == 1).run()
        rays = np.flatnonzero(np.isfinite(trace.distances))
        points = origins[rays] + trace.distances[rays, None] * directions[rays]
        values, slopes = gradient(sdf, points)
        # One Newton step along the ray: a hit is within epsilon, not exact.
        against = (slopes * directions[rays]).sum(axis=1)
        shift = -values / np.where(np.abs(against) < 0.1, np.inf, against)
        distances = trace.distances[rays] + np.clip(shift, -CORRECTION, CORRECTION)
        points = origins[rays] + distances[:, None] * directions[rays]
        fragments = self._fragments(rays, distances, points, slopes, directions[rays])
        return Cast(fragments, trace.steps, trace.lost)

    def _fragments(
        self,
        rays: Int64Array,
        distances: Float32Array,
        points: Float32Array,
        slopes: Float32Array,
        towards: Float32Array,
    ) -> Fragments:
        table = self._field.charts
        normals = slopes / np.maximum(np.linalg.norm(slopes, axis=1, keepdims=True), 1e-12)
        charts = self._queries.charts(points)
        uvs = self._queries.uv(points, charts)
        return Fragments(
            rays=rays,
            distances=distances,
            normals=normals,
            facing=(normals * towards).sum(axis=1) < 0,
            uvs=uvs,
            jacobians=self._jacobians(points, normals, charts, uvs),
            materials=self._chart_materials[charts],
            textured=table.has_uv[charts],
            charts=charts,
        )

    def _jacobians(
        self, points: Float32Array, normals: Float32Array, charts: Int32Array, uvs: Float32Array
    ) -> Float32Array:
        """(n, 2, 3): the UV network's Jacobian within the tangent plane, by two more queries."""
        jacobians = np.zeros((len(points), 2, 3), np.float32)
        for axis in tangent_axes(normals):
            moved = self._queries.uv(points + OFFSET * axis, charts)
            jacobians += ((moved - uvs) / OFFSET)[:, :, None] * axis[:, None, :]
        return jacobians
