"""Small meshes to simplify: smooth, open, cut by seams, of many bodies."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import Frame
from nispcodec.core.mesh_part import MeshPart
from nispcodec.simplify.config import FitConfig, LadderConfig
from nispcodec.simplify.ladder import Simplifier
from nispcodec.simplify.triangles import Triangles
from tests.geometry import shapes

UNIT = Frame((0.0, 0.0, 0.0), 1.0)
SMALL_FIT = FitConfig(rounds=4, uv_rounds=3, fewest=3000, most=6000)
SMALL = LadderConfig(samples=4000, fewest=30, fit=SMALL_FIT)


def triangles_of(mesh: TexturedMesh) -> Triangles:
    """The triangles of a mesh that is in the normalized frame."""
    return Triangles.of(mesh, UNIT)


def ball(rings: int = 14) -> Triangles:
    """The unit sphere in two charts, above and below, with a seam around."""
    corners = shapes.sphere(rings)
    below = corners[..., 2].mean(axis=1) < 0
    uvs = corners[..., :2] * 0.2 + np.where(below, 0.75, 0.25)[:, None, None]
    return triangles_of(shapes.soup(corners, uvs))


def sheet(count: int = 14) -> Triangles:
    """A wavy square that is open, of one chart."""
    corners = shapes.grid(count)
    bent = corners.copy()
    bent[..., 2] = 0.2 * np.sin(2 * corners[..., 0]) * np.cos(2 * corners[..., 1])
    return triangles_of(shapes.soup(bent, (corners[..., :2] + 1) / 2))


def bare_ball(rings: int = 10) -> Triangles:
    """The unit sphere without UVs."""
    corners = shapes.sphere(rings)
    mesh = TexturedMesh.geometry_only(
        corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3), "ball"
    )
    return triangles_of(mesh)


def half_dressed_ball(rings: int = 10) -> Triangles:
    """The unit sphere: UVs above, none below."""
    mesh = shapes.soup(shapes.sphere(rings))
    below = mesh.corners[..., 2].mean(axis=1) < 0
    return triangles_of(replace(mesh, uv_faces=np.where(below[:, None], -1, mesh.uv_faces)))


def cards(count: int = 300, seed: int = 0) -> Triangles:
    """Squares of two triangles each, strewn about."""
    rng = np.random.default_rng(seed)
    square: Float64Array = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float) - 0.5
    turns = np.linalg.qr(rng.normal(size=(count, 3, 3)))[0]
    spots = np.einsum("cij,kj->cki", turns, square * 0.05) + rng.uniform(-0.6, 0.6, (count, 1, 3))
    corners = spots[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3, 3)
    uvs = np.tile(square[[[0, 1, 2], [0, 2, 3]]][..., :2] + 0.5, (count, 1, 1))
    return triangles_of(shapes.soup(corners, uvs))


def area(triangles: Triangles) -> float:
    """Of all faces."""
    a, b, c = np.moveaxis(triangles.corners, 1, 0)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def coded(parts: tuple[MeshPart, ...]) -> int:
    """Bytes as any coder takes: so many for each vertex and UV by their bits, and each face."""
    bits = 0
    for part in parts:
        bits += int(part.positions.max()).bit_length() * part.positions.size
        bits += int(part.uvs.max(initial=0)).bit_length() * part.uvs.size
        bits += 2 * len(part.faces) + 200 * (len(part.placements) - 1)
    return bits // 8 + 10


def simplifier(triangles: Triangles) -> Simplifier:
    """Makes candidates quickly."""
    return Simplifier.of(triangles, coded, SMALL)
