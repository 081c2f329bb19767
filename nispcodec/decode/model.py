"""A decoded asset as something to ask: distance, normal, chart, UV, colour at any point; a mesh."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nispcodec.asset import TexturedMesh
from nispcodec.decode.evaluate import evaluate, gradient
from nispcodec.document import Document
from nispcodec.errors import QueryError

Floats = NDArray[np.float32]
Integers = NDArray[np.int32]

FRAMES = ("world", "normalised")
PROJECTION_STEPS = 8


class NispModel:
    """One asset, queryable at any point.

    Queries take points (n, 3), any n, in the frame named by `frame`: "world" (the asset's own
    units) or "normalised". They raise QueryError for a wrong shape, NaN, infinity or an unknown
    frame. Work is done in blocks on every core; memory is bounded beyond input and output.
    """

    def __init__(self, document: Document) -> None:
        self.document = document

    def sdf(self, points: ArrayLike, frame: str = "world") -> Floats:
        """Signed distance to the surface (n,) float32, negative inside, in the units of `frame`."""
        scale = np.float32(self.document.frame.radius if frame == "world" else 1)
        values: Floats = evaluate(self.document.sdf, self._normalised(points, frame))[:, 0]
        values *= scale
        return values

    def normals(self, points: ArrayLike, frame: str = "world") -> Floats:
        """Unit gradient of the SDF (n, 3) float32, pointing outwards; 0 where the SDF is flat."""
        _, slopes = gradient(self.document.sdf, self._normalised(points, frame))
        lengths = np.linalg.norm(slopes, axis=1, keepdims=True)
        units = np.zeros_like(slopes)
        np.divide(slopes, lengths, out=units, where=lengths > 0)
        return units

    def charts(self, points: ArrayLike, frame: str = "world") -> Integers:
        """The chart that each point belongs to (n,) int32, into `document.charts`."""
        return self._charts(self._normalised(points, frame))

    def uv(
        self, points: ArrayLike, frame: str = "world", charts: NDArray[np.integer] | None = None
    ) -> Floats:
        """Texture coordinates (n, 2) float32, origin bottom-left, in the asset's UV range.

        `charts` (n,) overrides the predicted charts. Points on charts without UV get (0, 0).
        """
        normalised = self._normalised(points, frame)
        return self._uv(normalised, self._charts(normalised) if charts is None else charts)

    def color(self, points: ArrayLike, frame: str = "world") -> Floats:
        """Base colour (n, 4) float32 RGBA in [0, 1], sRGB-encoded.

        RGB is the value stored in the base colour texture, interpolated as stored, times the
        material's factor put into sRGB; alpha is linear: the texture's times the factor's.
        """
        from nispcodec.decode.color import base_color

        normalised = self._normalised(points, frame)
        charts = self._charts(normalised)
        uvs = self._uv(normalised, charts)
        result = np.empty((len(normalised), 4), np.float32)
        materials = self.document.charts.materials[charts]
        textured = self.document.charts.has_uv[charts]
        for index, has_uv in set(zip(materials.tolist(), textured.tolist(), strict=True)):
            rows = (materials == index) & (textured == has_uv)
            pixels = self._pixels(index) if has_uv else None
            material = self.document.materials[index]
            result[rows] = base_color(material, pixels, uvs[rows], int(rows.sum()))
        return result

    def project(self, points: ArrayLike, frame: str = "world") -> NDArray[np.float64]:
        """The points moved along the gradient onto the surface (n, 3) float64, in `frame`.

        Newton steps on the fitted field: exact near the surface, approximate far from it.
        """
        moved = self._normalised(points, frame)
        for _ in range(PROJECTION_STEPS):
            values, slopes = gradient(self.document.sdf, moved)
            steepness = np.maximum((slopes * slopes).sum(axis=1, keepdims=True), 0.25)
            moved = moved - values[:, None] * slopes / steepness
        if frame == "world":
            return self.document.frame.to_world(moved)
        return moved.astype(np.float64)

    def to_mesh(self, resolution: int | None = None, keep_spurious: bool = False) -> TexturedMesh:
        """The surface as a textured mesh in the world frame.

        `resolution`: cells along the edge of the cube that is extracted; default 256, or more when
        the asset has sheets thinner than that resolves. `keep_spurious` keeps the components that
        are recognised as noise of the field.
        """
        from nispcodec.decode.meshing import textured_mesh

        return textured_mesh(self.document, resolution, keep_spurious)[0]

    def _charts(self, normalised: Floats) -> Integers:
        from nispcodec.decode.face_charts import predicted_charts

        return predicted_charts(self.document.chart, normalised)

    def _uv(self, normalised: Floats, charts: NDArray[np.integer]) -> Floats:
        from nispcodec.decode.meshing import asset_uv

        return asset_uv(self.document, normalised, charts)

    def _pixels(self, material: int) -> NDArray[np.uint8] | None:
        used = self.document.materials[material].maps.get("base_color")
        return None if used is None else self._textures[used.texture]

    @cached_property
    def _textures(self) -> dict[int, NDArray[np.uint8]]:
        from nispcodec.decode.color import decoded

        maps = (material.maps.get("base_color") for material in self.document.materials)
        wanted = {used.texture for used in maps if used is not None}
        return {index: decoded(self.document.textures[index]) for index in wanted}

    def _normalised(self, points: ArrayLike, frame: str) -> Floats:
        if frame not in FRAMES:
            raise QueryError(f"frame: expected one of {', '.join(FRAMES)}, found {frame!r}")
        array = np.asarray(points)
        if array.ndim != 2 or array.shape[1] != 3 or array.dtype.kind not in "fiu":
            raise QueryError(
                f"points: expected numbers of shape (n, 3), found {array.dtype} of {array.shape}"
            )
        if not np.isfinite(array).all():
            row = int(np.argmin(np.isfinite(array).all(axis=1)))
            raise QueryError(f"points: expected finite numbers, found {array[row]} in row {row}")
        if frame == "world":
            array = self.document.frame.to_normalised(array)
        return array.astype(np.float32)
