"""One body of many: its corners, and whether another body is a copy of it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from nispcodec.core.arrays import AnyArray, BoolArray, Float64Array, Int64Array
from nispcodec.core.mesh_part import Placement
from nispcodec.core.placing import placed_points
from nispcodec.simplify.config import CopiesConfig
from nispcodec.simplify.similarity import similarity
from nispcodec.simplify.triangles import Triangles


@dataclass(frozen=True)
class Body:
    """Faces (k,) of triangles that hang together, the corners of each in an order (k, 3)."""

    triangles: Triangles
    faces: Int64Array
    order: Int64Array

    @staticmethod
    def of(triangles: Triangles, faces: Int64Array) -> Body:
        """Its corners as they are."""
        return Body(triangles, faces, np.tile(np.arange(3), (len(faces), 1)))

    @cached_property
    def vertices(self) -> Int64Array:
        """(k, 3): the numbers of the positions of all corners."""
        return np.take_along_axis(self.triangles.faces[self.faces], self.order, axis=1)

    @cached_property
    def corners(self) -> Float64Array:
        """(3 k, 3): the positions of all corners."""
        return self.triangles.positions[self.vertices.ravel()]

    @cached_property
    def uvs(self) -> Float64Array:
        """(3 d, 2): the UVs of the corners that have one."""
        numbers = self.triangles.uv_faces[self.faces[self.dressed]]
        ordered = np.take_along_axis(numbers, self.order[self.dressed], axis=1)
        return self.triangles.uvs[ordered.ravel()]

    @cached_property
    def dressed(self) -> BoolArray:
        """(k,) bool: which faces have UVs."""
        return self.triangles.has_uv[self.faces]

    @cached_property
    def size(self) -> float:
        """Root of the mean square of the distance of corners from their mean."""
        spread = np.square(self.corners - self.corners.mean(axis=0)).sum(axis=1)
        return float(np.sqrt(spread.mean()))

    @cached_property
    def shape(self) -> float:
        """Area by square of size: the same for copies."""
        a, b, c = np.moveaxis(self.corners.reshape(-1, 3, 3), 1, 0)
        area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
        return float(area) / max(self.size**2, np.finfo(np.float64).tiny)


def placement_of(body: Body, copy: Body, mirrored: bool, config: CopiesConfig) -> Placement | None:
    """How a copy, corner for corner, is one of the body; None where it is not.

    mirrored: whether as a reflection, whose faces are in the order that makes them look inwards.
    """
    if not _same_kinds(body, copy):
        return None
    fitted = similarity(body.corners, copy.corners, mirrored)
    tolerance = config.tolerance
    found = _tidy(fitted, tolerance / max(float(np.abs(body.corners).max()), 1.0))
    if _largest(placed_points(found, body.corners) - copy.corners) > tolerance:
        return None
    scale, offset = _affine(body.uvs, copy.uvs, config.uv_tolerance)
    if _largest(body.uvs * scale + offset - copy.uvs) > config.uv_tolerance:
        return None
    (su, sv), (u, v) = scale, offset
    return replace(found, uv_scale=(su, sv), uv_offset=(u, v))


def _same_kinds(body: Body, copy: Body) -> bool:
    """Whether the same faces have UVs and are of sheets, and each patch has one material."""
    sheet, copy_sheet = body.triangles.sheet[body.faces], copy.triangles.sheet[copy.faces]
    if (body.dressed != copy.dressed).any() or (sheet != copy_sheet).any():
        return False
    patches = body.triangles.patches[body.faces]
    _, firsts, which = np.unique(patches, return_index=True, return_inverse=True)
    materials = copy.triangles.materials[copy.faces]
    return bool((materials == materials[firsts][which]).all())


def _tidy(placement: Placement, tolerance: float) -> Placement:
    """With the numbers that take no room in a file, 0 and 1, in place of near ones."""
    w, x, y, z = (_near(part, tolerance / 10, 0.0, 1.0) for part in placement.rotation)
    right, up, front = (_near(part, tolerance / 10, 0.0) for part in placement.offset)
    scale = _near(placement.scale, tolerance / 10, 1.0)
    return replace(placement, rotation=(w, x, y, z), offset=(right, up, front), scale=scale)


def _near(value: float, tolerance: float, *wanted: float) -> float:
    return next((each for each in wanted if abs(value - each) <= tolerance), float(value))


def _affine(
    source: Float64Array, target: Float64Array, tolerance: float
) -> tuple[list[float], list[float]]:
    """Scales and shifts of both axes that bring UVs (n, 2) to (n, 2) by least squares."""
    scales, shifts = [1.0, 1.0], [0.0, 0.0]
    for axis in range(2 if len(source) else 0):
        given, wanted = source[:, axis], target[:, axis]
        spread = given - given.mean()
        if np.abs(spread).max() > tolerance:
            scale = float(spread @ (wanted - wanted.mean()) / (spread @ spread))
            scales[axis] = _near(scale, tolerance / 10, 1.0)
        shift = float(wanted.mean() - scales[axis] * given.mean())
        shifts[axis] = _near(shift, tolerance / 10, 0.0)
    return scales, shifts


def _largest(values: AnyArray) -> float:
    return float(np.abs(values).max(initial=0.0))
