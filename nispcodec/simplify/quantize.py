"""Triangles rounded to integer grids: a mesh part, as a file holds it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import Float64Array, Int32Array, Int64Array
from nispcodec.core.connectivity import connected_components
from nispcodec.core.mesh_part import MAX_GRID_BITS, MeshPart
from nispcodec.simplify.curves import own_corners
from nispcodec.simplify.shading import written_creases
from nispcodec.simplify.triangles import Triangles, side_numbers

STEP_DIGITS = 10
"""Binary digits of a step: its multiples up to 2^14 are exact in float32."""


@dataclass(frozen=True)
class Grid:
    """Integers for numbers: number = integer * step + origin, integers from 0 to 2^bits - 1.

    origin (d,)
    """

    origin: Float64Array
    step: float

    @staticmethod
    def of(numbers: Float64Array, bits: int) -> Grid:
        """The grid of `bits` over the bounding box of (n, d) numbers, alike along all axes.

        Raises ValueError for bits below 1 or above MAX_GRID_BITS.
        """
        if not 1 <= bits <= MAX_GRID_BITS:
            raise ValueError(f"bits: expected 1 to {MAX_GRID_BITS}, found {bits}")
        if not len(numbers):
            return Grid(np.zeros(numbers.shape[1]), 1.0)
        extent = float(np.ptp(numbers, axis=0).max())
        step = extent / ((1 << bits) - 1) if extent > 0 else 1.0
        # As a file holds them. Rounded down and up, so that no number is off the grid.
        low = numbers.min(axis=0).astype(np.float32)
        low = np.where(low > numbers.min(axis=0), np.nextafter(low, np.float32(-np.inf)), low)
        return Grid(
            low.astype(np.float64), float(np.nextafter(np.float32(step), np.float32(np.inf)))
        )

    def through(self, axis: int, at: float) -> Grid:
        """Much the same grid, with points where a coordinate is `at`.

        Its step is a little longer, of so few digits that the origin is a multiple in a file, too.
        """
        share, exponent = math.frexp(self.step)
        step = math.ldexp(math.ceil(math.ldexp(share, STEP_DIGITS)), exponent - STEP_DIGITS)
        origin = self.origin.copy()
        origin[axis] = at - step * round((at - origin[axis]) / step)
        return Grid(origin, step)

    def around(self, numbers: Float64Array) -> Grid:
        """The same grid, its origin moved along it to just below all of other numbers (n, d)."""
        if not len(numbers):
            return self
        steps = np.floor((numbers.min(axis=0) - self.origin) / self.step)
        low = (self.origin + steps * self.step).astype(np.float32)
        return Grid(low.astype(np.float64), self.step)

    def integers(self, numbers: Float64Array) -> Int32Array:
        """(n, d) int32: the nearest."""
        return np.rint((numbers - self.origin) / self.step).astype(np.int32)


def quantized(triangles: Triangles, bits: int, uv_bits: int) -> MeshPart:
    """The part of these triangles with so many bits a coordinate.

    Edges whose ends fall together are collapsed, so that no hole opens; the two faces at each go.
    Raises ValueError for bits below 1 or above MAX_GRID_BITS.
    """
    grid, uv_grid = Grid.of(triangles.positions, bits), Grid.of(triangles.uvs, uv_bits)
    return on_grids(triangles, grid, uv_grid)


def on_grids(triangles: Triangles, grid: Grid, uv_grid: Grid) -> MeshPart:
    """The same on grids that are given."""
    welded = _collapsed(triangles, grid.integers(triangles.positions))
    charts, firsts = charts_of(welded)
    return MeshPart(
        positions=grid.integers(welded.positions),
        faces=welded.faces.astype(np.int32),
        uvs=uv_grid.integers(welded.uvs),
        uv_faces=welded.uv_faces.astype(np.int32),
        face_charts=charts,
        chart_materials=welded.materials[firsts],
        chart_has_uv=welded.has_uv[firsts],
        creases=written_creases(welded),
        sheet=welded.sheet,
        step=grid.step,
        origin=(float(grid.origin[0]), float(grid.origin[1]), float(grid.origin[2])),
        uv_step=(uv_grid.step, uv_grid.step),
        uv_origin=(float(uv_grid.origin[0]), float(uv_grid.origin[1])),
    )


def charts_of(triangles: Triangles) -> tuple[Int32Array, Int64Array]:
    """(m,) int32: faces that are connected over edges that are no seams share a number from 0 up.

    And the first face of each.
    """
    sides, faces = side_numbers(own_corners(triangles)), len(triangles)
    every = np.repeat(np.arange(faces), 3)
    _, labels = connected_components(every, sides.ravel() + faces, faces + int(sides.max()) + 1)
    _, firsts, charts = np.unique(labels[:faces], return_index=True, return_inverse=True)
    return charts.astype(np.int32), firsts


def _collapsed(triangles: Triangles, integers: Int32Array) -> Triangles:
    """Without the edges whose ends have equal integers (n, 3)."""
    starts, ends = triangles.faces, np.roll(triangles.faces, -1, axis=1)
    together = (integers[starts] == integers[ends]).all(axis=2)
    if not together.any():
        return triangles
    dressed = together & triangles.has_uv[:, None]
    uv_ends = np.roll(triangles.uv_faces, -1, axis=1)
    faces = _joined(triangles.faces, starts[together], ends[together], len(triangles.positions))
    uv_faces = _joined(
        triangles.uv_faces, triangles.uv_faces[dressed], uv_ends[dressed], len(triangles.uvs)
    )
    kept = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    if not kept.any():
        kept, faces, uv_faces = np.ones_like(kept), triangles.faces, triangles.uv_faces
    return Triangles(
        triangles.positions,
        faces[kept],
        triangles.uvs,
        uv_faces[kept],
        triangles.materials[kept],
        triangles.patches[kept],
        triangles.sheet[kept],
        None if triangles.creases is None else triangles.creases[kept],
    ).compact()


def _joined(faces: Int64Array, starts: Int64Array, ends: Int64Array, count: int) -> Int64Array:
    """Corners (m, 3), -1 for none, where those that edges join are the lowest of them."""
    number, labels = connected_components(starts, ends, count)
    lowest = np.full(number, count, np.int64)
    np.minimum.at(lowest, labels, np.arange(count))
    return np.append(lowest[labels], -1)[faces]
