"""Mesh parts of small shapes."""

from __future__ import annotations

from typing import Any

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int32Array
from nispcodec.core.mesh_part import MeshPart

CUBE_FACES = np.array(
    [
        *([0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4]),
        *([2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]),
    ],
    np.int32,
)


def cube(side: float = 1.0, center: tuple[float, float, float] = (0, 0, 0)) -> Float64Array:
    """(12, 3, 3) triangles that look outwards."""
    corners = np.array([[x, y, z] for z in (-0.5, 0.5) for y in (-0.5, 0.5) for x in (-0.5, 0.5)])
    triangles: Float64Array = (corners * side + center)[CUBE_FACES]
    return triangles


def sphere(rings: int, radius: float = 0.5) -> Float64Array:
    """(f, 3, 3) triangles that look outwards; two of each four at the poles have no area."""
    down, around = np.meshgrid(np.arange(rings + 1), np.arange(2 * rings), indexing="ij")
    polar, turn = down * np.pi / rings, around * np.pi / rings
    points = np.stack(
        [np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar)], axis=2
    )
    points[0], points[-1] = (0, 0, 1), (0, 0, -1)
    following = np.roll(points, -1, axis=1)
    a, b, c, d = points[:-1], points[1:], following[1:], following[:-1]
    triangles = np.concatenate([np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)])
    return radius * triangles.reshape(-1, 3, 3)


def part_of(
    corners: Float64Array, sheet: bool | BoolArray = False, charts: int = 1, **more: Any
) -> MeshPart:
    """Triangles (f, 3, 3) as a part whose UVs are x and y, its faces dealt to charts in turn."""
    bits, count = 16, len(corners)
    low = corners.min(axis=(0, 1))
    step = float((corners.max(axis=(0, 1)) - low).max() / (2**bits - 1))
    grid = np.rint((corners.reshape(-1, 3) - low) / step).astype(np.int32)
    positions, inverse = np.unique(grid, axis=0, return_inverse=True)
    faces: Int32Array = inverse.reshape(-1, 3).astype(np.int32)
    return MeshPart(
        positions=positions,
        faces=faces,
        uvs=positions[:, :2],
        uv_faces=faces,
        face_charts=(np.arange(count) % charts).astype(np.int32),
        chart_materials=np.arange(charts, dtype=np.int32),
        chart_has_uv=np.ones(charts, np.bool_),
        creases=np.zeros((count, 3), np.bool_),
        sheet=np.broadcast_to(sheet, count).copy(),
        step=step,
        origin=tuple(low.tolist()),
        uv_step=(step, step),
        uv_origin=(float(low[0]), float(low[1])),
        **more,
    )


def soup(count: int, seed: int = 0) -> Float64Array:
    """(count, 3, 3) triangles that have nothing to do with each other."""
    rng = np.random.default_rng(seed)
    centers = rng.uniform(-0.6, 0.6, (count, 1, 3))
    return centers + rng.normal(0, 0.1, (count, 3, 3))


def points_off(corners: Float64Array, count: int, seed: int = 0) -> Float64Array:
    """(count, 3) half of them anywhere in the cube, half near the triangles, none on them."""
    rng = np.random.default_rng(seed)
    half = -(-count // 2)
    near = points_on(corners, half, seed) + rng.normal(0, 0.01, (half, 3))
    return np.concatenate([rng.uniform(-1, 1, (half, 3)), near])[:count]


def points_on(corners: Float64Array, count: int, seed: int = 0) -> Float64Array:
    """(count, 3) on the triangles, as nearly as rounding has it."""
    rng = np.random.default_rng(seed)
    weights = rng.dirichlet((1, 1, 1), count)[:, :, None]
    points: Float64Array = (weights * corners[rng.integers(0, len(corners), count)]).sum(axis=1)
    return points


def points_about(corners: Float64Array, count: int, seed: int = 0) -> Float64Array:
    """(count, 3) off the triangles, on them, and at their corners."""
    half, fourth = -(-count // 2), -(-count // 4)
    some = np.random.default_rng(seed).integers(0, 3 * len(corners), fourth)
    off, on = points_off(corners, half, seed), points_on(corners, fourth, seed + 1)
    return np.concatenate([off, on, corners.reshape(-1, 3)[some]])[:count]
