"""A scene of 33 bodies of 6 shapes: a board, and turned pieces in two colors, some reflected."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import Float64Array, Int64Array
from nispcodec.core.asset import Material, TexturedMesh

# Radius and height of a profile from the foot to the tip, then lobes and depth of the carving.
PROFILES: dict[str, tuple[tuple[tuple[float, float], ...], int, float]] = {
    "pawn": (((0.36, 0), (0.34, 0.12), (0.2, 0.25), (0.12, 0.55), (0.22, 0.62), (0.0, 0.95)), 0, 0),
    "rook": (((0.4, 0), (0.38, 0.15), (0.24, 0.3), (0.22, 0.8), (0.32, 0.9), (0.3, 1.1)), 6, 0.12),
    "bishop": (((0.4, 0), (0.36, 0.15), (0.15, 0.35), (0.12, 0.9), (0.2, 1.1), (0, 1.5)), 1, 0.25),
    "knight": (((0.4, 0), (0.38, 0.15), (0.25, 0.3), (0.3, 0.7), (0.35, 1.0), (0, 1.3)), 2, 0.45),
    "queen": (((0.45, 0), (0.4, 0.2), (0.18, 0.4), (0.14, 1.2), (0.3, 1.4), (0.0, 1.7)), 8, 0.15),
}  # fmt: skip
ROW = ("rook", "knight", "bishop", "queen", "queen", "bishop", "knight", "rook")
WOOD, IVORY, EBONY = 0, 1, 2
SUNK = 0.002
"""How deep pieces stand in the board, in squares."""
CELL = 0.31
"""The part of the atlas, either way, that one shape has."""


@dataclass(frozen=True)
class Body:
    """Triangles with a UV for each corner: positions (n, 3), uvs (n, 2), faces (m, 3) into both."""

    positions: Float64Array
    uvs: Float64Array
    faces: Int64Array


def scene(across: int = 52) -> TexturedMesh:
    """Pieces of `across` columns of quads and about as many rows: 32 times 2 across² triangles."""
    bodies, materials = [_board(max(across // 3, 4))], [WOOD]
    shapes = {name: _piece(name, across) for name in PROFILES}
    rng = np.random.default_rng(0)
    for row, (names, color) in enumerate(
        ((ROW, IVORY), (("pawn",) * 8, IVORY), (("pawn",) * 8, EBONY), (ROW, EBONY))
    ):
        for column, name in enumerate(names):
            square = (column - 3.5, (0, 1, 6, 7)[row] - 3.5)
            turn = float(rng.uniform(0, 2 * np.pi))
            bodies.append(_stood(shapes[name], square, turn, mirrored=column > 3))
            materials.append(color)
    return _joined(bodies, materials)


def _piece(name: str, across: int) -> Body:
    """Turned, then carved: lobes that deepen upwards, and a dent that breaks the symmetry."""
    control, lobes, depth = PROFILES[name]
    places = np.linspace(0, len(control) - 1, across)
    knots, (radii, heights) = np.arange(len(control)), np.transpose(control)
    radius, height = np.interp(places, knots, radii), np.interp(places, knots, heights)
    smooth = np.convolve(np.pad(radius, 3, mode="edge"), np.full(7, 1 / 7), mode="valid")
    radius = np.where(radius > 0, smooth, 0.0)
    turn = np.linspace(0, 2 * np.pi, across + 1)
    up = (height / height.max())[:, None]
    dent = np.exp(-8 * (1 - np.cos(turn - 1)) - 40 * (up - 0.5) ** 2)
    rings = radius[:, None] * (1 + depth * up**2 * np.cos(lobes * turn) - 0.08 * dent)
    heights = np.broadcast_to(height[:, None], rings.shape)
    points = np.stack([rings * np.cos(turn), rings * np.sin(turn), heights], axis=2)
    # The first and last column of positions are the same to the bit; UVs have a seam there.
    points[:, -1] = points[:, 0]
    number = list(PROFILES).index(name) + 1
    corner = np.array([number % 3, number // 3]) / 3
    uvs = np.stack(np.meshgrid(np.linspace(0, 1, across + 1), np.linspace(0, 1, across)), axis=2)
    body = _grid(points, corner + 0.01 + CELL * uvs)
    return _closed(body, points[0], corner)


def _closed(body: Body, foot: Float64Array, corner: Float64Array) -> Body:
    """With a bottom: a fan, whose UVs are a small disc in the atlas."""
    count = len(foot) - 1
    middle = np.append(foot[:-1, :2].mean(axis=0), foot[0, 2])
    positions = np.concatenate([foot[:-1], middle[None]])
    uvs = corner + 0.01 + 0.02 * (positions[:, :2] + 1)
    ring = np.arange(count)
    fan = np.stack([np.full(count, count), np.roll(ring, -1), ring], axis=1)
    return Body(
        np.concatenate([body.positions, positions]),
        np.concatenate([body.uvs, uvs]),
        np.concatenate([body.faces, fan + len(body.positions)]),
    )


def _board(across: int) -> Body:
    """A slab whose six sides are six charts in one cell."""
    steps = np.linspace(-1, 1, across + 1)
    x, y = np.meshgrid(steps, steps, indexing="ij")
    flat = np.stack([x, y, np.ones_like(x)], axis=2)
    sides = []
    for side in range(6):
        axis, sign = side % 3, 1 - 2 * (side // 3)
        points = (np.roll(flat, axis, axis=2) * sign).round(9) * [4.3, 4.3, 0.2] - [0, 0, 0.2]
        cell = 0.01 + 0.1 * np.array([axis, side // 3])
        uvs = cell + 0.045 * (np.stack([x, y], axis=2) + 1)
        order = slice(None, None, -sign)
        sides.append(_grid(points[order], uvs[order]))
    return _one(sides)


def _grid(points: Float64Array, uvs: Float64Array) -> Body:
    """Quads of points (r, c, 3) as triangles; those without area, at a tip, are left out."""
    rows, columns = points.shape[:2]
    numbers = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = numbers[:-1, :-1], numbers[:-1, 1:], numbers[1:, 1:], numbers[1:, :-1]
    halves = (a, b, c), (a, c, d)
    faces = np.concatenate([np.stack(half, axis=2).reshape(-1, 3) for half in halves])
    flat = points.reshape(-1, 3)
    first, second, third = np.moveaxis(flat[faces], 1, 0)
    areas = np.linalg.norm(np.cross(second - first, third - first), axis=1)
    return Body(flat, uvs.reshape(-1, 2), faces[areas > 1e-12])


def _stood(body: Body, square: tuple[float, float], turn: float, mirrored: bool) -> Body:
    """A copy on a square of the board; a reflected one is wound the other way."""
    cos, sin = np.cos(turn), np.sin(turn)
    matrix = np.array([[cos, -sin, 0], [sin, cos, 0], [0, 0, 1]])
    given = body.positions * ([-1.0, 1.0, 1.0] if mirrored else [1.0, 1.0, 1.0])
    positions = given @ matrix.T + [*square, -SUNK]
    return Body(positions, body.uvs, body.faces[:, ::-1] if mirrored else body.faces)


def _one(bodies: list[Body]) -> Body:
    shifts = np.cumsum([0, *(len(body.positions) for body in bodies)])
    return Body(
        np.concatenate([body.positions for body in bodies]),
        np.concatenate([body.uvs for body in bodies]),
        np.concatenate([body.faces + at for body, at in zip(bodies, shifts, strict=False)]),
    )


def _joined(bodies: list[Body], materials: list[int]) -> TexturedMesh:
    body = _one(bodies)
    faces = body.faces.astype(np.int32)
    return TexturedMesh(
        positions=body.positions,
        faces=faces,
        uvs=body.uvs,
        uv_faces=faces,
        face_materials=np.repeat(materials, [len(each.faces) for each in bodies]).astype(np.int32),
        materials=(Material("wood"), Material("ivory"), Material("ebony")),
        name="pieces",
    )
