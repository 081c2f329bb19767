"""Bodies that are alike on both sides of a plane, and their parts."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.core.asset import Material
from nispcodec.core.document import Document
from nispcodec.core.mesh_part import MeshPart
from nispcodec.model import NispModel
from nispcodec.simplify.config import CopiesConfig
from nispcodec.simplify.copies import Copies
from nispcodec.simplify.halves import with_halves
from nispcodec.simplify.mirror import Mirror, planes_of
from nispcodec.simplify.quantize import Grid
from nispcodec.simplify.triangles import Triangles
from tests.geometry import shapes
from tests.simplify.meshes import UNIT, triangles_of

BITS = 12
CONFIG = CopiesConfig(fewest=20)
PLANES = planes_of(np.zeros(3))


def half(rows: int = 12) -> Float64Array:
    """(k, 3, 3): half a sphere, where x is at least 0, its faces looking outwards."""
    down, across = np.meshgrid(
        np.linspace(0, np.pi, rows + 1), np.linspace(-np.pi / 2, np.pi / 2, rows + 1), indexing="ij"
    )
    x, y, z = np.sin(down) * np.cos(across), np.sin(down) * np.sin(across), np.cos(down)
    points = np.stack([np.where(x < 1e-9, 0.0, x), np.where(np.abs(y) < 1e-9, 0.0, y), z], axis=-1)
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
    lower, upper = np.stack([a, b, c], axis=2)[:-1], np.stack([a, c, d], axis=2)[1:]
    return np.concatenate([lower.reshape(-1, 3, 3), upper.reshape(-1, 3, 3)])


def both_halves(corners: Float64Array) -> Float64Array:
    """(2 k, 3, 3): with what a mirror across x shows."""
    return np.concatenate([corners, (corners * [-1, 1, 1])[:, ::-1]])


def body(axis: int = 0, at: float = 0.0) -> Triangles:
    """A closed body like a pear, alike on both sides of one plane alone, UVs too."""
    x, y, z = np.moveaxis(both_halves(half()), -1, 0)
    bent = np.stack([x * (1 - 0.3 * z), y + 0.2 * z, z - 0.1 * y], axis=-1) * 0.5
    uvs = np.stack([np.abs(x) * 0.4, y * 0.2 + 0.3], axis=-1)
    turned = np.roll(bent, axis, axis=-1)
    turned[..., axis] += at
    return triangles_of(shapes.soup(turned, uvs))


def parts_of(copies: Copies) -> tuple[MeshPart, ...]:
    triangles = copies.triangles
    return copies.parts(triangles, Grid.of(triangles.positions, BITS), Grid.of(triangles.uvs, BITS))


def halved(triangles: Triangles, *planes: Mirror) -> Copies | None:
    return with_halves(Copies.none(triangles), planes or PLANES, CONFIG)


def model_of(parts: tuple[MeshPart, ...]) -> NispModel:
    return NispModel(Document(UNIT, (Material(),), (), meshes=parts))
