"""Bodies that stand for their copies: triangles as parts with placements."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from nispcodec.core.arrays import BoolArray, Float64Array, Int32Array, Int64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.connectivity import row_ids
from nispcodec.core.creases import turned_sides
from nispcodec.core.mesh_part import MeshPart, Placement
from nispcodec.core.placing import placed_points
from nispcodec.simplify.config import RoundingConfig
from nispcodec.simplify.mirror import Mirror
from nispcodec.simplify.quantize import Grid, on_grids
from nispcodec.simplify.rounding import rounded_along
from nispcodec.simplify.scene import scene
from nispcodec.simplify.triangles import Triangles, joined


@dataclass(frozen=True)
class Group:
    """Bodies, and where they stand: one with its copies, or all that have none.

    patches     the numbers of their patches
    placements  without materials
    materials   of each placement the material (p,) of each patch; None: as in the bodies
    weight      how large they are simplified, UVs too: with as much area as all copies, so that
                errors that every copy has count, and small bodies of many copies are not dropped
    shift       (3,) where they are simplified: apart from all others
    """

    patches: range
    placements: tuple[Placement, ...] = (Placement(),)
    materials: tuple[Int32Array | None, ...] = (None,)
    weight: float = 1.0
    shift: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def home(self, triangles: Triangles) -> Triangles:
        """Triangles as they were simplified, back in the normalized frame and the asset's UVs."""
        positions = (triangles.positions - np.asarray(self.shift)) / self.weight
        return replace(triangles, positions=positions, uvs=triangles.uvs / self.weight)

    def part(self, home: Triangles, grid: Grid, uv_grid: Grid) -> MeshPart:
        """The part made of the bodies, given in the normalized frame, with all placements."""
        part = on_grids(home, grid, uv_grid)
        placements = []
        for placement, by_patch in zip(self.placements, self.materials, strict=True):
            if by_patch is not None:
                # Which faces make a chart does not depend on what the materials are.
                copy = on_grids(self._painted(home, by_patch), grid, uv_grid)
                placement = replace(placement, materials=copy.chart_materials)
            placements.append(placement)
        return replace(part, placements=tuple(placements))

    def copies(self, home: Triangles) -> Iterator[Triangles]:
        """The simplified bodies in every place, each for itself."""
        for placement, by_patch in zip(self.placements, self.materials, strict=True):
            order = [0, 2, 1] if placement.mirrored else [0, 1, 2]
            copy = home if by_patch is None else self._painted(home, by_patch)
            yield replace(
                copy,
                positions=placed_points(placement, home.positions),
                faces=home.faces[:, order],
                uvs=home.uvs * placement.uv_scale + placement.uv_offset,
                uv_faces=home.uv_faces[:, order],
                creases=_turned(home.creases) if placement.mirrored else home.creases,
            )

    def _painted(self, home: Triangles, by_patch: Int32Array) -> Triangles:
        return replace(home, materials=by_patch[home.patches - self.patches.start])


@dataclass(frozen=True)
class Copies:
    """Triangles without the bodies that are copies of others, and groups of them in order.

    triangles  as they are to be simplified: each group with its weight, in its place
    covered    (m,) bool: the faces of the given triangles that are held, or that a copy has
    fewest_left  faces that must be left of a body for it to be placed
    mirror     the plane that halves are reflected in, if any: it is one of the grid's
    """

    triangles: Triangles
    groups: tuple[Group, ...]
    covered: BoolArray
    fewest_left: int = 0
    mirror: Mirror | None = None

    @staticmethod
    def none(triangles: Triangles, kept: BoolArray | None = None) -> Copies:
        """Where every body stands for itself; kept: (m,) bool, the faces held; None: all."""
        covered = np.ones(len(triangles), np.bool_) if kept is None else kept
        held = triangles if covered.all() else triangles.only(covered)
        return Copies(held, (Group(range(int(held.patches.max()) + 1)),), covered)

    @staticmethod
    def weighed(
        held: Triangles, groups: list[Group], covered: BoolArray, fewest_left: int
    ) -> Copies:
        """From triangles in the normalized frame, and groups of them that have no weight yet."""
        pieces = [piece.positions for _, piece in _pieces(held, groups)]
        weights = [np.sqrt(sum(each.scale**2 for each in group.placements)) for group in groups]
        sizes = [np.ptp(piece, axis=0).max() for piece in pieces]
        # Cells of a lattice, so wide that no body is near another.
        width = 2 * max(size * weight for size, weight in zip(sizes, weights, strict=True))
        across = (int(np.ceil(len(groups) ** (1 / 3))),) * 3
        placed = []
        for number, (group, piece, weight) in enumerate(zip(groups, pieces, weights, strict=True)):
            low = weight * piece.min(axis=0)
            x, y, z = (width * np.array(np.unravel_index(number, across)) - low).tolist()
            placed.append(replace(group, weight=float(weight), shift=(x, y, z)))
        return Copies(_enlarged(held, placed), tuple(placed), covered, fewest_left)

    @staticmethod
    def of_homes(homes: Sequence[tuple[Group, Triangles]], whole: Copies, mirror: Mirror) -> Copies:
        """Groups, with weights, and their triangles in the normalized frame, in place of others."""
        groups, pieces, first = [], [], 0
        for group, home in homes:
            patches = row_ids(home.patches[:, None]) + first
            groups.append(replace(group, patches=range(first, int(patches.max()) + 1)))
            pieces.append(replace(home, patches=patches.astype(np.int32)))
            first = groups[-1].patches.stop
        triangles = _enlarged(joined(*pieces), groups)
        return Copies(triangles, tuple(groups), whole.covered, whole.fewest_left, mirror)

    @property
    def homes(self) -> list[tuple[Group, Triangles]]:
        """Each group with its triangles in the normalized frame."""
        pieces = _pieces(self.triangles, self.groups)
        return [(group, group.home(piece)) for group, piece in pieces]

    def parts(self, triangles: Triangles, grid: Grid, uv_grid: Grid) -> tuple[MeshPart, ...]:
        """The simplified triangles as parts, rounded to the nearest points of the grids.

        A group of which no face is left has no part; copies of one of which few are left are faces
        like others.
        """
        if self.mirror is not None:
            grid = grid.through(self.mirror.axis, self.mirror.at)
        return tuple(
            group.part(home, grid.around(home.positions), uv_grid.around(home.uvs))
            for group, home in self._held(triangles)
        )

    def rounded(
        self, triangles: Triangles, grid: Grid, config: RoundingConfig, seed: int
    ) -> Triangles:
        """The simplified triangles with vertices moved to points of the grid, along the surface."""
        weights, shifts = _weights(triangles, self.groups)
        places = ((triangles.positions - shifts) / weights - grid.origin) / grid.step
        found = rounded_along(triangles, places, config, seed) * grid.step + grid.origin
        return replace(triangles, positions=found * weights + shifts)

    def scene(self, triangles: Triangles) -> TexturedMesh:
        """The triangles with all their copies, in the materials of the bodies."""
        pieces = _pieces(triangles, self.groups)
        return scene([(group.home(piece).mesh(), group.placements) for group, piece in pieces])

    def vertices_at(self, places: Float64Array, tolerance: float) -> BoolArray:
        """(n,): vertices of `triangles` that stand, or copies of them, at one of (k, 3) places."""
        weights, shifts = _weights(self.triangles, self.groups)
        homes = (self.triangles.positions - shifts) / weights
        owners, tree = _vertex_owners(self.triangles, self.groups), cKDTree(places)
        found = np.zeros(len(homes), np.bool_)
        for number, group in enumerate(self.groups):
            own = np.flatnonzero(owners == number)
            for placement in group.placements:
                found[own] |= tree.query(placed_points(placement, homes[own]))[0] <= tolerance
        return found

    def _held(self, triangles: Triangles) -> Iterator[tuple[Group, Triangles]]:
        """The triangles of each part, in the normalized frame; first all that has no placements."""
        plain, held = [], []
        for group, piece in _pieces(triangles, self.groups):
            home = group.home(piece)
            if len(group.placements) > 1 and len(home) >= self.fewest_left:
                held.append((group, home))
            else:
                plain += list(group.copies(home)) if len(group.placements) > 1 else [home]
        if plain:
            yield Group(range(0)), plain[0] if len(plain) == 1 else joined(*plain)
        yield from held


def _turned(creases: BoolArray | None) -> BoolArray | None:
    return None if creases is None else turned_sides(creases)


def _pieces(triangles: Triangles, groups: Sequence[Group]) -> Iterator[tuple[Group, Triangles]]:
    """The triangles of each group that has some."""
    if len(groups) == 1:
        yield groups[0], triangles
        return
    owners = _owners(triangles, groups)
    for number in np.unique(owners):
        yield groups[number], triangles.only(np.asarray(owners == number))


def _owners(triangles: Triangles, groups: Sequence[Group]) -> Int64Array:
    """(m,): the number of the group of each face."""
    starts = [group.patches.start for group in groups]
    return np.searchsorted(starts, triangles.patches, side="right") - 1


def _vertex_owners(triangles: Triangles, groups: Sequence[Group]) -> Int64Array:
    """(n,): the number of the group of each position."""
    owners = np.zeros(len(triangles.positions), np.int64)
    owners[triangles.faces] = _owners(triangles, groups)[:, None]
    return owners


def _enlarged(held: Triangles, groups: Sequence[Group]) -> Triangles:
    """Each group with its weight, in its place."""
    weights, shifts = _weights(held, groups)
    of_uv = np.ones(len(held.uvs))
    of_uv[held.uv_faces[held.has_uv]] = weights[held.faces[held.has_uv], 0]
    positions = held.positions * weights + shifts
    return replace(held, positions=positions, uvs=held.uvs * of_uv[:, None])


def _weights(triangles: Triangles, groups: Sequence[Group]) -> tuple[Float64Array, Float64Array]:
    """(n, 1), (n, 3): the weight and shift of the group that each position is of."""
    owners = _vertex_owners(triangles, groups)
    weights = np.array([group.weight for group in groups])[owners, None]
    return weights, np.array([group.shift for group in groups])[owners]
