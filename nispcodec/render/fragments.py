"""What a ray finds on a surface: everything that shading wants to know, whatever was hit."""

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
    materials  (n,) int32
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
    """What became of n rays: fragments of those that hit, how often the field was asked for each
    ray (n,), and which were given up (n,) before they hit or left.
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
        """What the fragments' materials index."""

    @property
    def textures(self) -> tuple[Texture, ...]:
        """What the materials' maps index."""

    def cast(self, origins: Float32Array, directions: Float32Array, layer: int) -> Cast:
        """Where rays (n, 3), of unit directions, first cross the surface.

        `layer` counts the crossings behind the origins: 0 for rays that come from the camera.
        """
