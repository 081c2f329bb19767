"""Assets of smooth, dense bodies beside sheets and low-poly ones: a garden, and a still life."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from nispcodec.core.arrays import Float64Array, IntArray
from nispcodec.core.asset import Material, TexturedMesh

Surface = tuple[Float64Array, Float64Array, IntArray]
"""Positions (n, 3), UVs (n, 2) for each of them, faces (m, 3) into both."""
Shape = Callable[[Float64Array, Float64Array], Float64Array]
"""Grids (r, c) of parameters in [0, 1] down and across -> positions (r, c, 3)."""

STONE, LEAF, WOOD, CLOTH = range(4)
MATERIALS = (Material("stone"), Material("leaf"), Material("wood"), Material("cloth"))


def garden(dense: int = 120, leaves: int = 40) -> TexturedMesh:
    """A smooth statue of 4 dense² triangles on a plinth of three slabs, among leaves: cards."""
    random = np.random.default_rng(0)
    parts = [(_statue(dense), STONE)]
    for number, (width, top) in enumerate(((0.8, -0.95), (0.95, -1.1), (1.2, -1.3))):
        size = np.array([width, 0.08 + 0.02 * number, width])
        parts.append((_box(size, np.array([0, top, 0]), 2 + number), STONE))
    for number in range(leaves):
        parts.append((_leaf(random, number), LEAF))
    return _joined(parts, "garden")


def still_life(dense: int = 110) -> TexturedMesh:
    """A fluted vase of 4 dense² triangles beside a crate of boards, on a cloth."""
    parts = [(_round(_vase, dense, 0), STONE)]
    parts += [(board, WOOD) for board in _crate(np.array([1.5, -0.45, 0.1]))]
    parts.append((_sheet(_cloth, 14, 14, 15), CLOTH))
    return _joined(parts, "still_life")


def _statue(dense: int) -> Surface:
    """A ball with lobes that turn as they rise, and a dent: smooth, and not symmetric."""

    def shape(down: Float64Array, across: Float64Array) -> Float64Array:
        turn, fall = 2 * np.pi * (across % 1), np.pi * down
        flat = np.sin(np.pi * np.minimum(down, 1 - down))
        lobes = 0.18 * np.cos(3 * turn + 4 * fall) + 0.08 * np.sin(5 * turn - 3 * fall)
        dent = 0.25 * np.exp(-6 * (1 - np.cos(turn - 1)) - 8 * (down - 0.4) ** 2)
        radius = 0.6 * (1 + flat**2 * lobes - flat * dent)
        ring = radius * flat
        return np.stack([ring * np.cos(turn), 1.4 * radius * np.cos(fall), -ring * np.sin(turn)], 2)

    return _round(shape, dense, 0)


def _vase(down: Float64Array, across: Float64Array) -> Float64Array:
    turn, fall = 2 * np.pi * (across % 1), np.pi * down
    flat = np.sin(np.pi * np.minimum(down, 1 - down))
    flutes = 0.05 * np.cos(9 * turn + 3 * fall) * flat**2
    ring = (0.55 + 0.2 * np.sin(5 * down + 0.5) + flutes) * np.sqrt(flat)
    return np.stack([ring * np.cos(turn), 1 - 2 * down, -ring * np.sin(turn)], axis=2)


def _cloth(down: Float64Array, across: Float64Array) -> Float64Array:
    x, z = 4.4 * across - 1.6, 1.3 - 2.6 * down
    sag = 0.06 * np.sin(5 * x + z) * np.cos(3 * z) + 0.25 * np.maximum(np.abs(z) - 0.9, 0)
    return np.stack([x, -1.12 - sag, z], axis=2)


def _leaf(random: np.random.Generator, number: int) -> Surface:
    """A bent card of two rows of quads, somewhere around the plinth."""

    def shape(down: Float64Array, across: Float64Array) -> Float64Array:
        bend = 0.12 * np.sin(np.pi * across)
        return np.stack([0.5 * across, bend, 0.14 * (down - 0.5)], axis=2)

    positions, uvs, faces = _sheet(shape, 3, 2, 5 + number % 8)
    turn, rise = random.uniform(0, 2 * np.pi), random.uniform(-0.3, 1.2)
    tilt = np.array([[np.cos(rise), -np.sin(rise), 0], [np.sin(rise), np.cos(rise), 0], [0, 0, 1]])
    place = np.array([random.uniform(0.9, 1.5), random.uniform(-1.2, -0.2), 0])
    return (positions @ tilt.T + place) @ _about(turn).T, uvs, faces


def _crate(middle: Float64Array) -> list[Surface]:
    """Sixteen boards around a box that is open above."""
    boards = []
    for side in range(4):
        for row in range(4):
            size, away = np.array([0.55, 0.11, 0.03]), np.array([0, 0.27 * row - 0.4, 0.52])
            positions, uvs, faces = _box(size, away, 2 + (4 * side + row) % 12)
            boards.append((positions @ _about(side * np.pi / 2).T + middle, uvs, faces))
    return boards


def _about(turn: float) -> Float64Array:
    """The matrix of a turn about the axis that points up."""
    cos, sin = np.cos(turn), np.sin(turn)
    return np.array([[cos, 0, sin], [0, 1, 0], [-sin, 0, cos]])


def _box(size: Float64Array, middle: Float64Array, cell: int) -> Surface:
    """Twelve triangles: six charts in a cell of the atlas; size (3,) is half of the edges."""
    corner, width = _cell(cell)
    flat = np.array([[-1.0, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]])
    positions, uvs, faces = [], [], []
    for side in range(6):
        axis, sign = side % 3, 1 - 2 * (side // 3)
        # Two signs turn a side over without a reflection.
        square = np.roll(flat * [1, sign, sign], axis, axis=1)
        positions.append(square * size + middle)
        at = corner + width * np.array([axis, side // 3]) / 3
        uvs.append(at + 0.15 * width * (flat[:, :2] + 1))
        faces.append(4 * side + np.array([[0, 1, 2], [0, 2, 3]]))
    return np.concatenate(positions), np.concatenate(uvs), np.concatenate(faces)


def _cell(number: int) -> tuple[Float64Array, float]:
    """Lower corner and width of one of the sixteen cells of the atlas."""
    return np.array([number % 4, number // 4]) / 4 + 0.01, 0.23


def _round(shape: Shape, rows: int, cell: int) -> Surface:
    """A surface with a pole at either end: two charts in cells of the atlas, both discs."""
    halves = []
    for half in range(2):
        down, across = _parameters(np.linspace(half, half + 1, rows // 2 + 1) / 2, 2 * rows)
        away, turn = 2 * np.abs(down - half), 2 * np.pi * (across % 1)
        disc = np.stack([away * np.cos(turn), away * np.sin(turn)], axis=2)
        corner, width = _cell(cell + half)
        halves.append(_quads(shape(down, across), corner + width * (disc + 1) / 2))
    return _one(halves)


def _sheet(shape: Shape, columns: int, rows: int, cell: int) -> Surface:
    down, across = _parameters(np.linspace(0, 1, rows + 1), columns)
    corner, width = _cell(cell)
    return _quads(shape(down, across), corner + width * np.stack([across, 1 - down], axis=2))


def _parameters(down: Float64Array, columns: int) -> tuple[Float64Array, Float64Array]:
    found = np.meshgrid(down, np.linspace(0, 1, columns + 1), indexing="ij")
    return found[0], found[1]


def _quads(positions: Float64Array, uvs: Float64Array) -> Surface:
    """Grids of positions and UVs (r, c, ...) as triangles; those without area are left out."""
    rows, columns = positions.shape[:2]
    grid = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]
    faces = np.concatenate([np.stack(half, 2).reshape(-1, 3) for half in ((a, c, b), (a, d, c))])
    flat = positions.reshape(-1, 3)
    first, second, third = np.moveaxis(flat[faces], 1, 0)
    areas = np.linalg.norm(np.cross(second - first, third - first), axis=1)
    return flat, uvs.reshape(-1, 2), faces[areas > 1e-12]


def _one(surfaces: list[Surface]) -> Surface:
    starts = np.cumsum([0, *(len(positions) for positions, _, _ in surfaces)])
    faces = [each[2] + at for each, at in zip(surfaces, starts, strict=False)]
    positions, uvs = (np.concatenate([each[which] for each in surfaces]) for which in (0, 1))
    return positions, uvs, np.concatenate(faces)


def _joined(parts: list[tuple[Surface, int]], name: str) -> TexturedMesh:
    positions, uvs, faces = _one([surface for surface, _ in parts])
    of_material = [np.full(len(surface[2]), material) for surface, material in parts]
    return TexturedMesh(
        positions=positions,
        faces=faces.astype(np.int32),
        uvs=uvs,
        uv_faces=faces.astype(np.int32),
        face_materials=np.concatenate(of_material).astype(np.int32),
        materials=MATERIALS,
        name=name,
    )
