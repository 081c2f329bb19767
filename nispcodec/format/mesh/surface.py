"""A surface as the file has it, and how the part that is encoded lies on it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import AnyArray, BoolArray, Int32Array, Int64Array
from nispcodec.core.mesh_part import MeshPart
from nispcodec.format.mesh import manifold


@dataclass(frozen=True)
class Given:
    """A part to encode, its sides in the order of the file.

    sides  (3 m,) int64: the side of `part` that each side of the file is
    twin   (3 m,) int64: the side of the file that each side of the file meets
    """

    part: MeshPart
    sides: Int64Array
    twin: Int64Array

    @property
    def faces(self) -> Int64Array:
        """(m,): the part's face that each face of the file is."""
        return self.sides[::3] // 3

    def vertices(self) -> list[int]:
        """The part's vertex at each corner of the file."""
        return self.part.faces.reshape(-1)[self.sides].tolist()

    def seams(self) -> BoolArray:
        """(3 m,): sides where UV or chart are others beyond."""
        uvs, charts = self.uvs(), self.part.face_charts[self.faces]
        corners = np.arange(len(self.sides))
        after, over = manifold.following(corners), self.twin
        apart = uvs != uvs[manifold.following(over)]
        apart |= uvs[after] != uvs[over]
        return apart.any(axis=1) | (charts[corners // 3] != charts[over // 3]) | (over < 0)

    def creases(self) -> BoolArray:
        """(3 m,): sides that are creases, or meet one."""
        own = self.part.creases.reshape(-1)[self.sides]
        return own | own[self.twin] & (self.twin >= 0)

    def uvs(self) -> Int32Array:
        """(3 m, 2): of each corner of the file; -1 where there are none."""
        none = np.full((1, 2), -1, dtype=np.int32)
        table: AnyArray = np.vstack([self.part.uvs, none])
        return table[self.part.uv_faces.reshape(-1)[self.sides]]
