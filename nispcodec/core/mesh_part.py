"""A part of an asset that is held as triangles: positions and UVs on integer grids."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from math import isfinite

import numpy as np

from nispcodec.core.arrays import AnyArray, BoolArray, Float64Array, Int32Array
from nispcodec.core.creases import sharp_sides
from nispcodec.core.errors import FormatError

PART = "mesh part"
"""The section in errors of this module, which knows no file."""
MAX_GRID_BITS = 20
MAX_PLACED_FACES = 2**21
"""Faces with all copies: what a search of them takes is about a gigabyte."""
UNIT_TOLERANCE = 1e-3
"""How far from 1 the squared length of a rotation in float32 may be."""
Quaternion = tuple[float, float, float, float]


@dataclass(frozen=True)
class Placement:
    """Where one copy of a part stands, and how it looks: normalized frame to normalized frame.

    A point p goes to scale * R(rotation) (p, its x negated before where `mirrored`) + offset.
    rotation       unit quaternion, w first
    uv_scale       of the copy's UVs, with uv_offset: asset UV = part UV * uv_scale + uv_offset
    materials      (k,) int32: the copy's material of each chart; None: the part's

    Raises FormatError for numbers that are not finite, a rotation that is no unit quaternion, and
    a scale that is not above 0.
    """

    rotation: Quaternion = (1.0, 0.0, 0.0, 0.0)
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    scale: float = 1.0
    mirrored: bool = False
    uv_scale: tuple[float, float] = (1.0, 1.0)
    uv_offset: tuple[float, float] = (0.0, 0.0)
    materials: Int32Array | None = None

    def __post_init__(self) -> None:
        _finite("rotation", self.rotation)
        length = sum(part * part for part in self.rotation)
        unit = abs(length - 1) <= UNIT_TOLERANCE
        _demand("rotation", unit, "a unit quaternion", self.rotation)
        _finite("offset", self.offset)
        _finite("scale", (self.scale,))
        _demand("scale", self.scale > 0, "above 0", self.scale)
        _finite("uv_scale", self.uv_scale)
        _finite("uv_offset", self.uv_offset)


@dataclass(frozen=True)
class MeshPart:
    """Triangles with a UV for each corner, as a file holds them, and every copy of them.

    positions   (n, 3) int32 from 0 to 2^MAX_GRID_BITS - 1; normalized frame: times `step` + origin
    faces       (m, 3) int32 into positions
    uvs         (t, 2) int32, same range; the part's UV: times `uv_step` + uv_origin
    uv_faces    (m, 3) int32 into uvs; -1 in all three corners of a face of a chart without UV
    face_charts (m,) int32: the chart of each face, into the two below
    chart_materials (k,) int32: the material of each chart
    chart_has_uv    (k,) bool
    creases     (m, 3) bool: whether shading breaks over the edge from corner i to corner i + 1;
                where no edge is one, nobody said, see `shading_breaks`
    sheet       (m,) bool: faces of open sheets, which have no inside
    placements  at least one

    Raises FormatError for arrays that do not fit together.
    """

    positions: Int32Array
    faces: Int32Array
    uvs: Int32Array
    uv_faces: Int32Array
    face_charts: Int32Array
    chart_materials: Int32Array
    chart_has_uv: BoolArray
    creases: BoolArray
    sheet: BoolArray
    step: float
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    uv_step: tuple[float, float] = (1.0, 1.0)
    uv_origin: tuple[float, float] = (0.0, 0.0)
    placements: tuple[Placement, ...] = field(default_factory=lambda: (Placement(),))

    def __post_init__(self) -> None:
        faces, charts = len(self.faces), len(self.chart_materials)
        _shape("faces", self.faces, (faces, 3))
        _shape("uv_faces", self.uv_faces, (faces, 3))
        _shape("creases", self.creases, (faces, 3))
        _shape("sheet", self.sheet, (faces,))
        _shape("face_charts", self.face_charts, (faces,))
        _shape("chart_has_uv", self.chart_has_uv, (charts,))
        _demand("faces", faces > 0, "at least one", faces)
        _within("faces", self.faces, 0, len(self.positions))
        _within("face_charts", self.face_charts, 0, charts)
        _within("positions", self.positions, 0, 1 << MAX_GRID_BITS)
        _within("uvs", self.uvs, 0, 1 << MAX_GRID_BITS)
        dressed = self.chart_has_uv[self.face_charts]
        _within("uv_faces", self.uv_faces[dressed], 0, len(self.uvs))
        _within("uv_faces", self.uv_faces[~dressed], -1, 0)
        _finite("step", (self.step,))
        _demand("step", self.step > 0, "above 0", self.step)
        _finite("origin", self.origin)
        _finite("uv_step", self.uv_step)
        _finite("uv_origin", self.uv_origin)
        _demand("placements", len(self.placements) > 0, "at least one", 0)
        for each in self.placements:
            if each.materials is not None:
                _shape("placement_materials", each.materials, (charts,))

    @property
    def placed_faces(self) -> int:
        """How many faces all copies have together."""
        return len(self.faces) * len(self.placements)

    @property
    def placed_charts(self) -> int:
        """How many charts all copies have together."""
        return len(self.chart_materials) * len(self.placements)

    @cached_property
    def shading_breaks(self) -> BoolArray:
        """(m, 3): the creases; where there are none, the edges that turn by over 45 degrees."""
        if self.creases.any():
            return self.creases
        places = self.faces.astype(np.int64)
        return sharp_sides(places, self.positions[places].astype(np.float64))

    def normalized(self) -> Float64Array:
        """(n, 3) float64: the positions in the normalized frame, before any placement."""
        return self.positions * self.step + np.asarray(self.origin)

    def asset_uvs(self) -> Float64Array:
        """(t, 2) float64: the UVs before any placement."""
        return self.uvs * np.asarray(self.uv_step) + np.asarray(self.uv_origin)


def check_placed_faces(count: int) -> None:
    """Raises FormatError for more faces, with all copies of all parts, than can be searched."""
    _demand("placed_faces", count <= MAX_PLACED_FACES, f"at most {MAX_PLACED_FACES}", count)


def _finite(name: str, values: tuple[float, ...]) -> None:
    _demand(name, all(map(isfinite, values)), "finite numbers", values)


def _shape(name: str, array: AnyArray, expected: tuple[int, ...]) -> None:
    _demand(name, array.shape == expected, f"shape {expected}", array.shape)


def _within(name: str, array: Int32Array, low: int, end: int) -> None:
    fits = not array.size or (array.min() >= low and array.max() < end)
    _demand(
        name,
        bool(fits),
        f"{low} to {end - 1}",
        f"{array.min()} to {array.max()}" if array.size else "none",
    )


def _demand(name: str, holds: bool, expected: object, found: object) -> None:
    if not holds:
        raise FormatError(PART, name, expected, found)
