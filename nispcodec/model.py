"""A decoded asset as something to ask: distance, normal, chart, UV, color at any point; a mesh."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from nispcodec.core.arrays import Float32Array, Float64Array, Int32Array, IntArray
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import Document
from nispcodec.core.errors import QueryError
from nispcodec.core.extras import require
from nispcodec.infer.parts import Union

if TYPE_CHECKING:
    import trimesh

    from nispcodec.core.sdf_grid import SdfGrid

FRAMES = ("world", "normalized")
FAR = 1e6
# Points that are prepared, or looked up, at a time: both take many times the memory of the answer.
PART = 1 << 18


class NispModel:
    """One asset, queryable at any point.

    Queries take points (n, 3), any n, in the frame named by `frame`: "world" (the asset's own
    units) or "normalized". They raise QueryError for a wrong shape, NaN, infinity, points more
    than a million radii away, or an unknown frame. Work is done in blocks on every core, so memory
    is bounded beyond input and output.
    """

    def __init__(self, document: Document) -> None:
        self.document = document
        self._images: dict[int, Float32Array] = {}

    @cached_property
    def parts(self) -> Union:
        """The field and the meshes, to be asked in the normalized frame without checks."""
        return Union(self.document)

    def sdf(self, points: ArrayLike, frame: str = "world") -> Float32Array:
        """Signed distance to the surface (n,) float32, negative inside, in the units of `frame`.

        A fitted field is a distance near its surface; farther off its sign can be trusted, its
        value less (docs/physics.md). Beyond the ball around the asset, normalized |p| > 1.01, it
        may be anything. `sdf_grid` has exact distances.
        """
        scale = np.float32(self.document.frame.radius if frame == "world" else 1)
        return self.parts.sdf(self._normalized(points, frame)) * scale

    def normals(self, points: ArrayLike, frame: str = "world") -> Float32Array:
        """Unit gradient of the SDF (n, 3) float32, pointing outwards; 0 where the SDF is flat."""
        return self.parts.normals(self._normalized(points, frame))

    def charts(self, points: ArrayLike, frame: str = "world") -> Int32Array:
        """The chart that each point belongs to (n,) int32, into `chart_materials`."""
        return self.parts.charts(self._normalized(points, frame))

    @property
    def chart_materials(self) -> Int32Array:
        """The material of each chart (k,) int32, into `document.materials`."""
        return self.document.chart_materials

    def uv(
        self, points: ArrayLike, frame: str = "world", charts: IntArray | None = None
    ) -> Float32Array:
        """Texture coordinates (n, 2) float32, origin bottom-left, in the asset's UV range.

        `charts`, an integer array (n,), overrides the predicted charts. Points on charts without UV
        get (0, 0). Raises QueryError for a wrong number of charts and for unknown ones.
        """
        normalized = self._normalized(points, frame)
        if charts is None:
            charts = self.parts.charts(normalized)
        return self.parts.uv(normalized, _checked(charts, len(normalized), self.parts.chart_count))

    def color(self, points: ArrayLike, frame: str = "world") -> Float32Array:
        """Base color (n, 4) float32 RGBA in [0, 1]: RGB is sRGB-encoded, alpha linear.

        The base color texture at the point's UV, filtered and wrapped as its material says, times
        the material's factor; the factor alone where there is no texture or no UV. Openings have no
        color: points there get that of the likeliest chart of the asset. Raises MeshError for a
        texture that does not decode.
        """
        normalized = self._normalized(points, frame)
        charts = self.parts.charts(normalized, seen=True)
        uvs = self.parts.uv(normalized, charts)
        # A face without UV looks nothing up: its material shows its factor, key -1 - material.
        materials, has_uv = self.document.chart_materials, self.document.chart_has_uv
        keys = np.where(has_uv, materials, -1 - materials)[charts]
        colors = np.empty((len(normalized), 4), np.float32)
        for start in range(0, len(keys), PART):
            part = slice(start, start + PART)
            for key in np.unique(keys[part]).tolist():
                shown = keys[part] == key
                colors[part][shown] = self._base_color(key, uvs[part][shown])
        return colors

    def project(self, points: ArrayLike, frame: str = "world") -> Float64Array:
        """The points moved onto the surface (n, 3) float64, in `frame`.

        Onto the closest point of a mesh; by Newton steps on a fitted field: exact near its surface,
        approximate far from it.
        """
        moved = self.parts.project(self._normalized(points, frame))
        if frame == "world":
            return self.document.frame.to_world(moved)
        return moved.astype(np.float64)

    def to_mesh(
        self,
        resolution: int | None = None,
        faces: int | None = None,
        error: float | None = None,
        keep_spurious: bool = False,
    ) -> TexturedMesh:
        """The surface as a textured mesh in the world frame.

        `resolution`: cells along the edge of the cube that is extracted; default 256, up to 512
        where walls are thin, more for thin sheets. `faces`: the most triangles to
        return; the surface is simplified to fit. `error`: as few triangles as keep the mean
        distance to the field's surface below it, normalized frame. By default that is what nobody
        sees beside the field's own error; with a resolution alone, all triangles of the grid are
        kept. `keep_spurious` keeps the components that are recognized as noise of the field; a
        warning of the mesh counts those that were dropped.
        """
        from nispcodec.extract.meshing import textured_mesh

        return textured_mesh(self.document, resolution, faces, error, keep_spurious)[0]

    def to_lods(
        self,
        levels: int,
        resolution: int | None = None,
        faces: int | None = None,
        error: float | None = None,
        keep_spurious: bool = False,
    ) -> list[TexturedMesh]:
        """The surface in `levels` of detail from one extraction, the finest first: `to_mesh`'s.

        Each has about a quarter of the triangles of the one before: as many on a pixel from twice
        as far. Seams and bodies take some: a level that would have no fewer is the one before.
        Other arguments are those of `to_mesh`. Triangles that the file holds are simplified as the
        encoder does it, which needs `pip install 'nispcodec[encode]'`. Raises NispError without,
        QueryError for no level.
        """
        from nispcodec.extract.meshing import textured_levels

        if levels < 1:
            raise QueryError(f"levels: expected at least 1, found {levels}")
        return textured_levels(self.document, levels, resolution, faces, error, keep_spurious)[0]

    def sdf_grid(self, samples: int = 128, resolution: int | None = None) -> SdfGrid:
        """Signed distances on a grid around the asset, world frame: `values()`, `save("x.npz")`.

        `samples` is their number along the longest side, 16 to 1024, with three spacings around the
        surface. Distances are those to the decoded surface, exact wherever they are, while `sdf` is
        near the distance at the surface alone. `resolution` is that of `to_mesh`; openings are
        closed, noise is dropped. Raises QueryError for other numbers of samples, MeshError without
        a surface.
        """
        from nispcodec.extract.decoded_distance import sdf_grid

        return sdf_grid(self.document, samples, resolution)

    def to_trimesh(
        self,
        resolution: int | None = None,
        faces: int | None = None,
        error: float | None = None,
        keep_spurious: bool = False,
    ) -> trimesh.Scene:
        """The surface as a trimesh scene: for each material a `Trimesh` with UVs and PBR material.

        Arguments and frame are those of `to_mesh`; vertices are split at seams; trimesh rounds the
        factors of base colors to 8 bits. Warnings of that mesh, and what trimesh has no place for,
        are warned of as NispWarning. Needs `pip install 'nispcodec[trimesh]'`; raises
        NispError without, MeshError for a texture that does not decode.
        """
        require("trimesh", extra="trimesh", what_for="a trimesh scene")
        from trimesh import Scene, Trimesh
        from trimesh.parent import Geometry

        from nispcodec.io.write.trimesh_geometry import trimesh_arguments

        arguments = trimesh_arguments(self.to_mesh(resolution, faces, error, keep_spurious))
        made: dict[str, Geometry] = {name: Trimesh(**each) for name, each in arguments.items()}
        return Scene(made)

    def _base_color(self, key: int, uvs: Float32Array) -> Float32Array:
        from nispcodec.core.texture import base_color

        material = self.document.materials[key if key >= 0 else -1 - key]
        used = material.maps.get("base_color") if key >= 0 else None
        image = None if used is None else self._image(used.texture)
        return base_color(material, image, uvs)

    def _image(self, texture: int) -> Float32Array:
        from nispcodec.core.texture import decode_image

        if texture not in self._images:
            self._images[texture] = decode_image(self.document.textures[texture])
        return self._images[texture]

    def _normalized(self, points: ArrayLike, frame: str) -> Float32Array:
        if frame not in FRAMES:
            raise QueryError(f"frame: expected one of {', '.join(FRAMES)}, found {frame!r}")
        array = np.asarray(points)
        if array.ndim != 2 or array.shape[1] != 3 or array.dtype.kind not in "fiu":
            raise QueryError(
                f"points: expected numbers of shape (n, 3), found {array.dtype} of {array.shape}"
            )
        normalized = np.empty(array.shape, np.float32)
        for start in range(0, len(array), PART):
            part = array[start : start + PART]
            moved = self.document.frame.to_normalized(part) if frame == "world" else part
            near = (np.abs(moved) < FAR).all(axis=1)
            if not near.all():
                row = int(np.argmin(near))
                raise QueryError(
                    f"points: expected finite numbers within {FAR:g} radii of the asset, "
                    f"found {part[row].tolist()} in row {start + row}"
                )
            normalized[start : start + PART] = moved
        return normalized


def _checked(charts: IntArray, points: int, count: int) -> IntArray:
    if charts.shape != (points,) or charts.dtype.kind not in "iu":
        found = f"{charts.dtype} of shape {charts.shape}"
        raise QueryError(f"charts: expected an integer for each of {points} points, found {found}")
    if points and not (charts.min() >= 0 and charts.max() < count):
        found = f"{charts.min()} to {charts.max()}"
        raise QueryError(f"charts: expected 0 to {count - 1}, found {found}")
    return charts
