"""Pictures of a textured mesh: first hits of rays, Lambert shading, the base-colour texture.

The same for the original and the decode, so that pictures can be compared.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from nispcodec.asset import TexturedMesh
from nispcodec.document import Frame
from nispcodec.metrics.color import color_at
from nispcodec.metrics.surface import Array, Indices, Surface, SurfacePoints

Picture = NDArray[np.float32]

SUPERSAMPLING = 2
AMBIENT, DIFFUSE = 0.35, 0.65
# Where a face leans further than this from the smoothed normal, it is a hard edge.
CREASE = 0.8


@dataclass(frozen=True)
class Camera:
    """A pinhole camera in the normalised frame, y up, looking from `eye` at `target`."""

    eye: tuple[float, float, float]
    target: tuple[float, float, float] = (0.0, 0.0, 0.0)
    angle: float = 32.0

    @cached_property
    def axes(self) -> Array:
        """(3, 3): right, up and forward unit vectors as rows."""
        forward = np.subtract(self.target, self.eye)
        forward /= np.linalg.norm(forward)
        right = np.cross(forward, (0.0, 1.0, 0.0))
        right /= np.linalg.norm(right)
        return np.stack([right, np.cross(right, forward), forward])

    def rays(self, size: int) -> Array:
        """Unit directions (size * size, 3) through the pixels' centres, top row first."""
        reach = np.tan(np.radians(self.angle) / 2)
        across = (np.arange(size) + 0.5) / size * 2 - 1
        x, y = np.meshgrid(across * reach, -across * reach)
        directions = np.stack([x, y, np.ones_like(x)], axis=-1).reshape(-1, 3) @ self.axes
        unit: Array = directions / np.linalg.norm(directions, axis=1, keepdims=True)
        return unit


def turntable(count: int = 4, elevation: float = 20.0, distance: float = 3.7) -> list[Camera]:
    """`count` cameras around the y axis that see the whole unit sphere."""
    high, flat = np.sin(np.radians(elevation)), np.cos(np.radians(elevation))
    turns = np.radians(30 + 360 * np.arange(count) / count)
    eyes = distance * np.stack([flat * np.sin(turns), high + 0 * turns, flat * np.cos(turns)], 1)
    return [Camera((float(x), float(y), float(z))) for x, y, z in eyes]


class Scene:
    """A mesh ready to be seen, placed by `frame` (that of the original, for a fair comparison)."""

    def __init__(self, mesh: TexturedMesh, frame: Frame) -> None:
        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene

        self.surface = Surface.of(mesh, frame)
        self._embree = EmbreeScene()
        TriangleMesh(self._embree, self.surface.positions.astype(np.float32), mesh.faces)

    def render(self, camera: Camera, size: int = 512) -> Picture:
        """(size, size, 3) float32 in [0, 1], sRGB-encoded, on white."""
        fine = size * SUPERSAMPLING
        directions = camera.rays(fine)
        rows, points = self.hits(np.asarray(camera.eye), directions)
        picture = np.ones((fine * fine, 3), dtype=np.float32)
        light = -camera.axes[2] + 0.6 * camera.axes[1] - 0.5 * camera.axes[0]
        shade = self._shade(points, directions[rows], light / np.linalg.norm(light))
        picture[rows] = color_at(self.surface, points)[:, :3] * shade[:, None]
        blocks = picture.reshape(size, SUPERSAMPLING, size, SUPERSAMPLING, 3)
        averaged: Picture = blocks.mean(axis=(1, 3))
        return averaged

    def hits(self, eye: Array, directions: Array) -> tuple[Indices, SurfacePoints]:
        """Which of the rays (n, 3) from `eye` meet the surface, and where first."""
        origins = np.broadcast_to(eye, directions.shape).astype(np.float32)
        found = self._embree.run(origins, directions.astype(np.float32), output=True)
        rows = np.flatnonzero(found["primID"] >= 0)
        u, v = found["u"][rows].astype(np.float64), found["v"][rows].astype(np.float64)
        faces, weights = found["primID"][rows].astype(np.int64), np.stack([1 - u - v, u, v], axis=1)
        return rows, SurfacePoints(faces, weights, self.surface.interpolate(faces, weights))

    def _shade(self, points: SurfacePoints, directions: Array, light: Array) -> Picture:
        flat = self.surface.normals[points.faces]
        corners = self._vertex_normals[self.surface.mesh.faces[points.faces]]
        smooth = np.einsum("nk,nkd->nd", points.weights, corners)
        smooth /= np.maximum(np.linalg.norm(smooth, axis=1, keepdims=True), 1e-12)
        hard = (smooth * flat).sum(axis=1) < CREASE
        normals = np.where(hard[:, None], flat, smooth)
        # Both sides of a face are lit: original files are not always oriented.
        facing = np.where((flat * directions).sum(axis=1) > 0, -1.0, 1.0)
        lambert = np.clip(normals @ light * facing, 0, 1)
        return (AMBIENT + DIFFUSE * lambert).astype(np.float32)

    @cached_property
    def _vertex_normals(self) -> Array:
        mesh = self.surface.mesh
        _, welded = np.unique(mesh.positions, axis=0, return_inverse=True)
        welded = welded.reshape(-1)
        sums = np.zeros((len(mesh.positions), 3))
        weighted = np.repeat(self.surface.normals * self.surface.areas[:, None], 3, axis=0)
        np.add.at(sums, welded[mesh.faces.ravel()], weighted)
        unit: Array = sums / np.maximum(np.linalg.norm(sums, axis=1, keepdims=True), 1e-300)
        return unit[welded]
