"""Signed distance to the decoded surface: exact wherever it is asked.

What a fitted network answers is a distance near the surface alone: far from it the value is off by
tenths of the radius, and beyond the ball around the asset it may be negative where nothing is.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from nispcodec.core.arrays import Float32Array, Float64Array, FloatArray
from nispcodec.core.document import Document
from nispcodec.core.errors import MeshError, QueryError
from nispcodec.core.sdf_grid import SdfGrid
from nispcodec.extract.config import ExtractConfig, GridConfig
from nispcodec.extract.isosurface import Surface
from nispcodec.extract.meshing import field_surface
from nispcodec.infer.mesh_queries import PlacedMeshes
from nispcodec.infer.mesh_search import MeshSearch


class DecodedDistance:
    """The surface of a document, to be asked at points (n, 3) in the normalized frame.

    A field is its extracted surface, openings closed and noise dropped (`warnings`); `resolution`
    is that of `textured_mesh`. Raises MeshError where there is no surface.
    """

    def __init__(
        self,
        document: Document,
        resolution: int | None = None,
        config: ExtractConfig = ExtractConfig(),
    ) -> None:
        self.warnings: tuple[str, ...] = ()
        self._parts: list[Callable[[Float64Array], Float32Array]] = []
        corners: list[FloatArray] = [np.zeros((0, 3))]
        if document.field:
            surface, report = field_surface(document.field, resolution, None, False, config)
            self.warnings = report.warnings
            self._parts.append(_of_surface(surface))
            corners.append(surface.positions)
        if document.meshes:
            meshes = PlacedMeshes(document.meshes)
            self._parts.append(meshes.sdf)
            corners.append(meshes.triangles.corners.reshape(-1, 3))
        self._corners: Float64Array = np.concatenate(corners)
        if not len(self._corners):
            raise MeshError("expected a surface, found none")

    def __call__(self, points: Float64Array) -> Float32Array:
        """(n,) signed distances, negative inside."""
        return np.minimum.reduce([part(points) for part in self._parts])

    @property
    def box(self) -> Float64Array:
        """(2, 3): the lowest and the highest coordinates of the surface."""
        return np.stack([self._corners.min(axis=0), self._corners.max(axis=0)])


def _of_surface(surface: Surface) -> Callable[[Float64Array], Float32Array]:
    corners = surface.positions[surface.faces].astype(np.float64)
    search = MeshSearch(corners, np.zeros(len(corners), np.bool_))

    def sdf(points: Float64Array) -> Float32Array:
        distances = np.sqrt(search.closest(points)[1]).astype(np.float32)
        return np.where(search.inside(points), -distances, distances)

    return sdf


def sdf_grid(
    document: Document,
    samples: int,
    resolution: int | None = None,
    config: GridConfig = GridConfig(),
) -> SdfGrid:
    """A grid around the surface, `samples` along its longest side, world frame.

    Its outermost samples are `config.margin` spacings off the surface's box, or more. Raises
    QueryError for another number of samples than `config` has, MeshError as `DecodedDistance`.
    """
    if not config.least <= samples <= config.most:
        raise QueryError(f"samples: expected {config.least} to {config.most}, found {samples}")
    distance, frame = DecodedDistance(document, resolution), document.frame
    low, high = frame.to_world(distance.box)
    around = 2 * config.margin
    spacing = float((high - low).max()) / (samples - 1 - around)
    # A hair less than a whole number of spacings is one.
    shape = np.ceil((high - low) / spacing - 1e-6).astype(int) + 1 + around
    origin = (low + high) / 2 - spacing * (shape - 1) / 2

    def in_world(points: Float64Array) -> Float32Array:
        return distance(frame.to_normalized(points)) * np.float32(frame.radius)

    x, y, z = origin.tolist()
    along_x, along_y, along_z = shape.tolist()
    return SdfGrid((x, y, z), spacing, (along_x, along_y, along_z), in_world, distance.warnings)
