"""Surface that is far from another one, or of another color: how much, and most of it where."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int32Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.connectivity import connected_components, row_ids
from nispcodec.metrics.surface import SurfacePoints

FAR = 0.01
"""Surface that is further than this from another one has no counterpart (normalized frame)."""
LINK = 0.05
"""Faulty points that are no further apart than this are of one place (normalized frame)."""
CORNERS = np.indices((2, 2, 2)).reshape(3, -1).T


@dataclass(frozen=True, eq=False)
class Place:
    """A box around faulty points that hang together: center (3,) and extent (3,), normalized frame.

    material  the one that most of the points have
    """

    center: Float64Array
    extent: Float64Array
    material: int


@dataclass(frozen=True, eq=False)
class FaultyPoints:
    """Those of `count` points spread evenly over a surface where another one fails to hold it.

    positions  (k, 3), normalized frame
    materials  (k,) of the faces that they are on
    """

    count: int = 0
    positions: Float64Array = field(default_factory=lambda: np.zeros((0, 3)))
    materials: Int32Array = field(default_factory=lambda: np.zeros(0, np.int32))

    @staticmethod
    def of(mesh: TexturedMesh, points: SurfacePoints, faulty: BoolArray) -> FaultyPoints:
        """Those of n points on a mesh that are faulty (n,)."""
        materials = mesh.face_materials[points.faces[faulty]]
        return FaultyPoints(len(points), points.positions[faulty], materials)

    def in_larger(self, share: float) -> FaultyPoints:
        """The same of a surface of which theirs is such a share of the area."""
        return replace(self, count=round(self.count / share))

    @property
    def share(self) -> float:
        """Share of the surface's area."""
        return len(self.positions) / max(self.count, 1)

    @property
    def largest(self) -> Place:
        """Where most of the points hang together. Raises ValueError where there are none."""
        # Points hang together that are in one cell of a grid, or in cells that share a corner.
        corners = np.floor(self.positions / LINK).astype(np.int64)[:, None] + CORNERS
        nodes = row_ids(corners.reshape(-1, 3)).reshape(-1, 8)
        first, others = nodes[:, :1].repeat(7, axis=1), nodes[:, 1:]
        _, labels = connected_components(first, others, int(nodes.max()) + 1)
        places = labels[nodes[:, 0]]
        chosen = places == np.bincount(places).argmax()
        material = int(np.bincount(self.materials[chosen]).argmax())
        low, high = self.positions[chosen].min(axis=0), self.positions[chosen].max(axis=0)
        return Place((low + high) / 2, high - low, material)
