"""Assets that short fits turn into webs and beans: a fan's cage of wires, and cards with leaves."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.core.asset import TexturedMesh
from tests.geometry.shapes import soup


def cage(wires: int = 6, sides: int = 4, steps: int = 16, thickness: float = 0.012) -> TexturedMesh:
    """Rings of wire through the poles of the unit sphere, 100 units up: as of a desk fan."""
    around, along = np.linspace(0, 2 * np.pi, sides + 1), np.linspace(0, 2 * np.pi, steps + 1)
    rings = [_ring(np.pi * turn / wires, around, along, thickness) for turn in range(wires)]
    return soup(np.concatenate(rings) + np.array([0.0, 100.0, 0.0]))


def cards(count: int = 24, size: float = 0.2) -> TexturedMesh:
    """Squares that cross each other every way within the unit ball."""
    random = np.random.default_rng(0)
    frames = np.linalg.qr(random.normal(size=(count, 3, 3)))[0]
    middles = random.uniform(-0.6, 0.6, (count, 1, 3))
    square = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * size
    corners = middles + np.einsum("kc,nci->nki", square, frames[:, :2])
    return soup(corners[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3, 3))


def _ring(turn: float, around: Float64Array, along: Float64Array, thickness: float) -> Float64Array:
    """(m, 3, 3): the outward triangles of a torus about a horizontal axis."""
    radius = 1 + thickness * np.cos(around)[:, None]
    flat, up = radius * np.cos(along), radius * np.sin(along)
    side = np.broadcast_to(thickness * np.sin(around)[:, None], flat.shape)
    cosine, sine = np.cos(turn), np.sin(turn)
    grid = np.stack([flat * cosine - side * sine, up, flat * sine + side * cosine], axis=2).round(9)
    a, b, c, d = grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]
    return np.stack([np.stack([a, b, c], 2), np.stack([a, c, d], 2)], 2).reshape(-1, 3, 3)
