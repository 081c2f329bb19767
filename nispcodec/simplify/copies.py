"""Bodies that stand for their copies: triangles as parts with placements."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from nispcodec.core.arrays import BoolArray, Int32Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.mesh_part import MeshPart, Placement
from nispcodec.simplify.quantize import Grid, on_grids
from nispcodec.simplify.scene import scene
from nispcodec.simplify.triangles import Triangles


@dataclass(frozen=True)
class Group:
    """Bodies, and where they stand: one with its copies, or all that have none.

    patches     the numbers of their patches
    placements  without materials
    materials   of each placement the material (p,) of each patch; None: as in the bodies
    """

    patches: range
    placements: tuple[Placement, ...] = (Placement(),)
    materials: tuple[Int32Array | None, ...] = (None,)

    def part(
        self, triangles: Triangles, grid: Grid, uv_grid: Grid, crease_angle: float | None
    ) -> MeshPart:
        """What was made of the bodies, with all placements."""
        part = on_grids(triangles, grid, uv_grid, crease_angle)
        placements = []
        for placement, by_patch in zip(self.placements, self.materials, strict=True):
            if by_patch is not None:
                materials = by_patch[triangles.patches - self.patches.start]
                # Which faces make a chart does not depend on what the materials are.
                copy = on_grids(replace(triangles, materials=materials), grid, uv_grid)
                placement = replace(placement, materials=copy.chart_materials)
            placements.append(placement)
        return replace(part, placements=tuple(placements))


@dataclass(frozen=True)
class Copies:
    """Triangles without the bodies that are copies of others, and groups of them in order.

    covered (m,) bool: the faces of the given triangles that are held, or that a copy has
    """

    triangles: Triangles
    groups: tuple[Group, ...]
    covered: BoolArray

    @staticmethod
    def none(triangles: Triangles, kept: BoolArray | None = None) -> Copies:
        """Where every body stands for itself; kept: (m,) bool, the faces held; None: all."""
        covered = np.ones(len(triangles), np.bool_) if kept is None else kept
        held = triangles if covered.all() else triangles.only(covered)
        return Copies(held, (Group(range(int(held.patches.max()) + 1)),), covered)

    def parts(
        self, triangles: Triangles, bits: int, uv_bits: int, crease_angle: float | None = None
    ) -> tuple[MeshPart, ...]:
        """What was made of the triangles by simplifying as parts, rounded as `quantized` rounds.

        All have one grid. A group of which no face is left has no part.
        """
        grid, uv_grid = Grid.of(triangles.positions, bits), Grid.of(triangles.uvs, uv_bits)
        return tuple(
            group.part(piece, grid.around(piece.positions), uv_grid.around(piece.uvs), crease_angle)
            for group, piece in self._pieces(triangles)
        )

    def scene(self, triangles: Triangles) -> TexturedMesh:
        """What was made of the triangles with all its copies, in the materials of the bodies."""
        pieces = self._pieces(triangles)
        return scene([(piece.mesh(), group.placements) for group, piece in pieces])

    def _pieces(self, triangles: Triangles) -> Iterator[tuple[Group, Triangles]]:
        if len(self.groups) == 1:
            yield self.groups[0], triangles
            return
        starts = [group.patches.start for group in self.groups]
        owners = np.searchsorted(starts, triangles.patches, side="right") - 1
        for number in np.unique(owners):
            yield self.groups[number], triangles.only(np.asarray(owners == number))
