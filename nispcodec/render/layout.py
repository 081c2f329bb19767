"""UV layouts as pictures: where points of the surface lie in the texture."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.core.arrays import Float32Array, Float64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import Frame
from nispcodec.metrics.sides import sides_of
from nispcodec.metrics.surface import Surface, SurfacePoints
from nispcodec.metrics.uv import uv_at
from nispcodec.model import NispModel

POINTS = 150_000


def layouts(
    original: TexturedMesh, decoded: NispModel | TexturedMesh, frame: Frame, size: int
) -> tuple[Float32Array, Float32Array, Float32Array]:
    """The UV layouts of both (size, size, 3), and the distance between them (size, size).

    All are float32, top row first. They show points of the original that are not hidden inside of
    it. A point has the color of its original UV in both: misplaced points stand out. The distance
    is in UV and shown at the original UV. The meshes are in the world frame; `frame` is the
    original's. Raises MeshError when a mesh has no surface.
    """
    surface = Surface.of(original, frame)
    points = _spread_over_uv(surface)
    points = points[~sides_of(surface, points).hidden]
    theirs, ours = uv_at(surface, points), _decoded_uvs(decoded, frame, points)
    low = np.minimum(theirs.min(axis=0, initial=0), 0)
    span = max(1.0, float((theirs - low).max(initial=1)))
    colors = np.column_stack([theirs % 1, np.full(len(theirs), 0.5)])
    off = np.linalg.norm(ours - theirs, axis=1, keepdims=True)
    return (
        _plot((theirs - low) / span, colors, np.ones((size, size, 3))),
        _plot((ours - low) / span, colors, np.ones((size, size, 3))),
        _plot((theirs - low) / span, off, np.zeros((size, size, 1)))[..., 0],
    )


def _spread_over_uv(surface: Surface) -> SurfacePoints:
    """Points of the surface, even in the UV layout."""
    mesh = surface.mesh
    chosen = np.flatnonzero(mesh.has_uv)
    flat = np.column_stack([mesh.uvs, np.zeros(len(mesh.uvs))])
    laid_out = replace(
        mesh,
        positions=flat,
        faces=mesh.uv_faces[chosen],
        uv_faces=mesh.uv_faces[chosen],
        face_materials=mesh.face_materials[chosen],
        creases=None,
    )
    layout = Surface(laid_out, flat)
    if not layout.areas.any():  # a palette: every chart is a point
        return surface.sample(POINTS, np.random.default_rng(0))
    points = layout.sample(POINTS, np.random.default_rng(0))
    faces = chosen[points.faces]
    return SurfacePoints(faces, points.weights, surface.interpolate(faces, points.weights))


def _decoded_uvs(
    decoded: NispModel | TexturedMesh, frame: Frame, points: SurfacePoints
) -> Float64Array:
    if isinstance(decoded, NispModel):
        return decoded.uv(frame.to_world(points.positions)).astype(np.float64)
    surface = Surface.of(decoded, frame)
    return uv_at(surface, surface.closest(points.positions))


def _plot(places: Float64Array, values: Float64Array, ground: Float64Array) -> Float32Array:
    """The ground (size, size, k) with values (n, k) at places (n, 2) of the unit square."""
    size = len(ground)
    cells = np.floor(places * size).astype(np.int64)
    inside = ((cells >= 0) & (cells < size)).all(axis=1)
    columns, rows = cells[inside].T
    ground[size - 1 - rows, columns] = values[inside]
    return ground.astype(np.float32)
