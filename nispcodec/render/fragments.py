"""Fragments: everything that shading wants to know of the points that rays hit."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Protocol

from nispcodec.core.arrays import BoolArray, Float32Array, Int32Array, Int64Array
from nispcodec.core.asset import Material, Texture
from nispcodec.core.document import Frame


@dataclass(frozen=True)
class Fragments:
    """n points on a surface, normalized frame.

    rays       (n,) int64, rising: which of the cast rays found it
    distances  (n,) float32 along the ray, from its origin
    normals    (n, 3) float32, unit, outwards
    facing     (n,) bool: seen from outside
    uvs        (n, 2) float32
    jacobians  (n, 2, 3) float32: how u and v change along x, y, z within the surface
    materials  (n,) int32, into the scene's materials
    textured   (n,) bool: has UVs
    charts     (n,) int32; -1 where the surface does not say
    """

    rays: Int64Array
    distances: Float32Array
    normals: Float32Array
    facing: BoolArray
    uvs: Float32Array
    jacobians: Float32Array
    materials: Int32Array
    textured: BoolArray
    charts: Int32Array

    def __len__(self) -> int:
        return len(self.rays)

    def __getitem__(self, chosen: BoolArray) -> Fragments:
        return Fragments(*(getattr(self, field.name)[chosen] for field in fields(self)))


@dataclass(frozen=True)
class Cast:
    """The result of casting n rays.

    fragments  where rays hit the surface
    steps      (n,) int32: how often the field was evaluated for each ray
    lost       (n,) bool: rays that were given up before they hit or left
    """

    fragments: Fragments
    steps: Int32Array
    lost: BoolArray


class Scene(Protocol):
    """Something to look at, placed in its normalized frame."""

    @property
    def frame(self) -> Frame:
        """The normalized frame's place in the world."""

    @property
    def materials(self) -> tuple[Material, ...]:
        """The materials that fragments refer to."""

    @property
    def textures(self) -> tuple[Texture, ...]:
        """The textures that the materials' maps refer to."""

    def cast(self, origins: Float32Array, directions: Float32Array, layer: int) -> Cast:
        """Where rays with origins (n, 3) and unit directions (n, 3) first cross the surface.

        Normalized frame. `layer` counts the crossings behind the origins: 0 for rays that come from
        the camera.
        """
