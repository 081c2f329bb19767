"""A mesh as a surface in the normalized frame: sampling it and finding closest points on it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import Frame
from nispcodec.core.errors import MeshError
from nispcodec.metrics.opposite_faces import opposite_faces

FLAT = 1e-7
"""A face whose height is less than this part of its longest edge is a line, to double precision."""

BLOCK = 1 << 14
"""Faces that are measured at a time."""

BEFORE = 2e-3
"""How far in front of one of two faces back to back one looks from (normalized frame)."""


def frame_of(mesh: TexturedMesh) -> Frame:
    """The normalized frame of a mesh: bounding-box center at 0, farthest used vertex at radius 1.

    Raises MeshError for a mesh without faces or of a single point.
    """
    used = mesh.positions[np.unique(mesh.faces)]
    if len(used) == 0:
        raise MeshError(f"{mesh.name}: expected a surface, found no faces")
    center = (used.min(axis=0) + used.max(axis=0)) / 2
    radius = float(np.linalg.norm(used - center, axis=1).max())
    if radius == 0:
        raise MeshError(f"{mesh.name}: expected a surface, found a single point")
    return Frame((float(center[0]), float(center[1]), float(center[2])), radius)


@dataclass(frozen=True)
class SurfacePoints:
    """n points on a surface.

    faces      (n,) int64, into the mesh's faces
    weights    (n, 3) float64, barycentric
    positions  (n, 3) float64, normalized frame
    """

    faces: Int64Array
    weights: Float64Array
    positions: Float64Array

    def __len__(self) -> int:
        return len(self.faces)

    def __getitem__(self, chosen: BoolArray) -> SurfacePoints:
        return SurfacePoints(self.faces[chosen], self.weights[chosen], self.positions[chosen])

    def __add__(self, other: SurfacePoints) -> SurfacePoints:
        return SurfacePoints(
            np.concatenate([self.faces, other.faces]),
            np.concatenate([self.weights, other.weights]),
            np.concatenate([self.positions, other.positions]),
        )


@dataclass(frozen=True)
class Surface:
    """A mesh with its positions (n, 3) in the normalized frame.

    Raises MeshError in `sample` and `closest` when no face has an area.
    """

    mesh: TexturedMesh
    positions: Float64Array

    @classmethod
    def of(cls, mesh: TexturedMesh, frame: Frame) -> Surface:
        """The surface of a mesh given in the world frame."""
        return cls(mesh, frame.to_normalized(mesh.positions))

    @cached_property
    def corners(self) -> Float64Array:
        """(m, 3, 3): the corners of every face, normalized frame."""
        return self.positions[self.mesh.faces]

    def corners_of(self, faces: Int64Array | BoolArray) -> Float64Array:
        """(n, 3, 3): those of some faces, which take less memory than all of them."""
        return self.positions[self.mesh.faces[faces]]

    @cached_property
    def areas(self) -> Float64Array:
        """(m,): the area of every face, normalized frame."""
        return self._in_blocks(lambda corners: _lengths(_crosses(corners)) / 2)

    @cached_property
    def normals(self) -> Float64Array:
        """(m, 3): the unit normal of every face, 0 for a face without area."""
        return self._in_blocks(_normals)

    def normals_at(self, faces: Int64Array) -> Float64Array:
        """(n, 3): the same of some faces (n,), without the others."""
        return self._in_blocks(_normals, faces)

    @cached_property
    def opposite_faces(self) -> Int64Array:
        """(m,): the face back to back with each face, -1 where there is none."""
        return opposite_faces(self.positions, self.mesh.faces, self.normals)

    @cached_property
    def diagonal(self) -> float:
        """Length of the bounding box's diagonal, normalized frame."""
        return float(np.linalg.norm(np.ptp(self.positions[np.unique(self.mesh.faces)], axis=0)))

    def sample(self, count: int, rng: np.random.Generator) -> SurfacePoints:
        """`count` points spread uniformly over the area, in the order of the faces."""
        cumulative = np.cumsum(self.areas[self._solid])
        # Sorted, neighbors in the list are neighbors in space: trees answer twice as fast.
        drawn = np.sort(rng.random(count)) * cumulative[-1]
        faces = self._solid[np.searchsorted(cumulative, drawn)]
        root, second = np.sqrt(rng.random(count)), rng.random(count)
        weights = np.stack([1 - root, root * (1 - second), root * second], axis=1)
        return SurfacePoints(faces, weights, self.interpolate(faces, weights))

    def outlook(self, points: SurfacePoints) -> Float64Array:
        """Positions (n, 3) from which to look for the counterparts of points on another surface.

        These are the points themselves; on one of two faces back to back they are `BEFORE` in front
        of it, or the counterpart might lie on the wrong side of a surface that has a thickness.
        """
        doubled = np.flatnonzero(self.opposite_faces[points.faces] >= 0)
        positions = points.positions.copy()
        positions[doubled] += BEFORE * self.normals[points.faces[doubled]]
        return positions

    def closest(self, points: Float64Array) -> SurfacePoints:
        """For each of (n, 3) points the closest point of the surface.

        Of two faces back to back that is on the one which looks towards the point.
        """
        import igl

        faces = np.asarray(self.mesh.faces[self._solid], dtype=np.int64)
        _, found, positions = igl.point_mesh_squared_distance(points, self.positions, faces)
        closest = self.facing(self._solid[found], positions - points)
        return SurfacePoints(closest, self.weights(closest, positions), positions)

    def weights(self, faces: Int64Array, positions: Float64Array) -> Float64Array:
        """(n, 3) barycentric weights of positions (n, 3) on faces (n,)."""
        import igl

        a, b, c = np.moveaxis(self.corners_of(faces), 1, 0)
        weights: Float64Array = np.clip(igl.barycentric_coordinates(positions, a, b, c), 0, 1)
        return weights / weights.sum(axis=1, keepdims=True)

    def facing(self, faces: Int64Array, towards: Float64Array) -> Int64Array:
        """The faces (n,), or those back to back with them where these face the viewer.

        `towards` (n, 3) are the directions in which one looks.
        """
        opposite = self.opposite_faces[faces]
        behind = (self.normals[faces] * towards).sum(axis=1) > 0
        return np.where(behind & (opposite >= 0), opposite, faces)

    def interpolate(self, faces: Int64Array, weights: Float64Array) -> Float64Array:
        """(n, 3) positions at barycentric weights (n, 3) of faces (n,)."""
        positions: Float64Array = np.einsum("nk,nkd->nd", weights, self.corners_of(faces))
        return positions

    def _in_blocks(
        self,
        measure: Callable[[Float64Array], Float64Array],
        chosen: Int64Array | slice = slice(None),
    ) -> Float64Array:
        """(n, ...) of corners (k, 3, 3), some faces at a time: those of all take much memory."""
        ends = self.mesh.faces[chosen]
        starts = range(0, max(len(ends), 1), BLOCK)
        return np.concatenate([measure(self.positions[ends[at : at + BLOCK]]) for at in starts])

    @cached_property
    def _solid(self) -> Int64Array:
        # Faces without area have no normal and no barycentric coordinates.
        solid = np.flatnonzero(2 * self.areas > FLAT * self._in_blocks(_longest))
        if len(solid) == 0:
            raise MeshError(f"{self.mesh.name}: expected a surface, found no face with an area")
        return solid


def _crosses(corners: Float64Array) -> Float64Array:
    a, b, c = np.moveaxis(corners, 1, 0)
    crosses: Float64Array = np.cross(b - a, c - a)
    return crosses


def _lengths(vectors: Float64Array) -> Float64Array:
    lengths: Float64Array = np.linalg.norm(vectors, axis=1)
    return lengths


def _normals(corners: Float64Array) -> Float64Array:
    crosses = _crosses(corners)
    return crosses / np.maximum(_lengths(crosses), np.finfo(np.float64).tiny)[:, None]


def _longest(corners: Float64Array) -> Float64Array:
    """(n,): the squares of the longest edges."""
    longest: Float64Array = np.square(corners - np.roll(corners, 1, axis=1)).sum(axis=2).max(axis=1)
    return longest
