"""The sample asset: a mug on a wooden saucer, made of nothing but this file and its textures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import Float64Array, Int64Array
from nispcodec.core.asset import Material, Texture, TexturedMesh, TextureMap
from nispcodec.procedural.textures import glaze_texture, wood_textures

SEGMENTS = 60
GLAZE, WOOD = 0, 1


@dataclass(frozen=True)
class Rectangle:
    """A region of the atlas in UV, from its lower left to its upper right corner."""

    low: tuple[float, float]
    high: tuple[float, float]

    def place(self, unit: Float64Array) -> Float64Array:
        """Points (..., 2) of [0, 1]^2 -> UVs in the region."""
        low = np.array(self.low)
        placed: Float64Array = low + unit * (np.array(self.high) - low)
        return placed


@dataclass(frozen=True)
class Span:
    """A stretch of a lathe's profile that becomes one chart.

    `control` holds (radius, height) points in centimeters, whose corners are cut `rounds` times
    between the ends. The chart is a disc when the span starts or ends on the axis, else a band.
    """

    control: Sequence[tuple[float, float]]
    region: Rectangle
    rounds: int = 1


@dataclass(frozen=True)
class Sheet:
    """A grid of quads: corners (r, c) into the positions of its body, uvs (r, c, 2).

    Seen from outside, columns run to the right and rows upwards.
    """

    corners: Int64Array
    uvs: Float64Array


@dataclass(frozen=True)
class Body:
    """A closed surface: sheets over common positions (n, 3), of one material."""

    positions: Float64Array
    sheets: Sequence[Sheet]
    material: int


# The foot ring sinks into the saucer: the two bodies overlap a little, as in real assets.
MUG = (
    Span([(0, 0.4), (2.1, 0.4), (2.5, 0.35), (2.6, 0)], Rectangle((0.64, 0.02), (0.86, 0.24))),
    Span(
        [
            (2.6, 0),
            (3, 0),
            (3.1, 0.5),
            (3.8, 1.4),
            (4.1, 3),
            (3.8, 6),
            (4.1, 8.7),
            (4, 9),
            (3.8, 9),
        ],
        Rectangle((0.02, 0.5), (0.98, 0.98)),
        rounds=2,
    ),
    Span(
        [(3.8, 9), (3.55, 8.9), (3.3, 6), (3.55, 3), (3.2, 1.7), (2.4, 1.1)],
        Rectangle((0.02, 0.2), (0.6, 0.47)),
    ),
    Span([(2.4, 1.1), (1.5, 0.95), (0, 0.95)], Rectangle((0.64, 0.26), (0.86, 0.48))),
)
SAUCER = (
    Span(
        [(0, -0.5), (3, -0.5), (3.3, -0.7), (3.9, -0.7), (4.2, -0.5), (7, 0.4), (7.2, 0.7)],
        Rectangle((0.01, 0.01), (0.57, 0.57)),
    ),
    Span(
        [(7.2, 0.7), (7.2, 1), (6.8, 1), (4.6, 0.15), (3.6, 0.08), (1.8, 0.08), (0, 0.08)],
        Rectangle((0.43, 0.43), (0.99, 0.99)),
    ),
)
# A cubic Bezier curve in the plane z = 0 whose ends lie within the wall of the mug.
HANDLE_PATH = np.array([(3.75, 7.4), (8.0, 8.6), (7.6, 1.2), (3.9, 2.8)])
HANDLE_RADII = (0.4, 0.55)
HANDLE_REGION = Rectangle((0.02, 0.03), (0.6, 0.17))


def sample_asset() -> TexturedMesh:
    """A textured asset of three closed bodies, seven charts and two materials; always the same.

    Centimeters, y up. Concave inside the mug and under its handle; no two charts overlap in UV.
    """
    wood_color, wood_normal = wood_textures()
    wood = {"base_color": TextureMap(1), "normal": TextureMap(2)}
    return _assembled(
        [_lathe(MUG, GLAZE), _handle(rows=28, around=14), _lathe(SAUCER, WOOD)],
        materials=(
            Material(name="glaze", roughness=0.25, maps={"base_color": TextureMap(0)}),
            Material(name="wood", roughness=0.8, maps=wood),
        ),
        textures=(glaze_texture(), wood_color, wood_normal),
    )


def _assembled(
    bodies: Sequence[Body], materials: tuple[Material, ...], textures: tuple[Texture, ...]
) -> TexturedMesh:
    positions, uvs = np.zeros((0, 3)), np.zeros((0, 2))
    faces, uv_faces, face_materials = [], [], []
    for body in bodies:
        for sheet in body.sheets:
            cells = _grid_triangles(*sheet.corners.shape)
            corners = sheet.corners.reshape(-1)[cells]
            whole = (corners != np.roll(corners, 1, axis=1)).all(axis=1)
            faces.append(corners[whole] + len(positions))
            used, uv_corners = np.unique(cells[whole], return_inverse=True)
            uv_faces.append(uv_corners.reshape(-1, 3) + len(uvs))
            face_materials.append(np.full(int(whole.sum()), body.material))
            uvs = np.concatenate([uvs, sheet.uvs.reshape(-1, 2)[used]])
        positions = np.concatenate([positions, body.positions])
    return TexturedMesh(
        positions=positions,
        faces=np.concatenate(faces).astype(np.int32),
        uvs=uvs,
        uv_faces=np.concatenate(uv_faces).astype(np.int32),
        face_materials=np.concatenate(face_materials).astype(np.int32),
        materials=materials,
        textures=textures,
        name="mug",
    )


def _grid_triangles(rows: int, columns: int) -> Int64Array:
    """Two triangles a cell, as indices into the flattened grid: (2 (r - 1) (c - 1), 3)."""
    grid = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]
    return np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)


def _lathe(spans: Sequence[Span], material: int) -> Body:
    """Turn profiles that meet end to end, from axis to axis, about the y axis."""
    profiles = [_rounded(span) for span in spans]
    profile = np.concatenate([profiles[0][:1], *[part[1:] for part in profiles]])
    angles = _angles(SEGMENTS)
    rings = [_ring(radius, height, angles[:-1]) for radius, height in profile]
    corners = _ring_corners([len(ring) for ring in rings], SEGMENTS)
    sheets, first = [], 0
    for span, part in zip(spans, profiles, strict=True):
        rows = corners[first : first + len(part)]
        sheets.append(Sheet(rows, span.region.place(_lathe_uvs(part, angles))))
        first += len(part) - 1
    return Body(np.concatenate(rings), sheets, material)


def _handle(rows: int, around: int) -> Body:
    """Sweep an ellipse along the handle's path and close both ends to a point."""
    t = np.linspace(0, 1, rows)[:, None]
    a, b, c, d = HANDLE_PATH
    path = (1 - t) ** 3 * a + 3 * (1 - t) ** 2 * t * b + 3 * (1 - t) * t**2 * c + t**3 * d
    tangents = np.gradient(path, axis=0)
    normals = tangents[:, ::-1] * (1, -1) / np.linalg.norm(tangents, axis=1, keepdims=True)
    angles = _angles(around)
    rings = [
        np.column_stack(
            [
                point + np.cos(angles[:-1, None]) * HANDLE_RADII[0] * normal,
                np.sin(angles[:-1]) * HANDLE_RADII[1],
            ]
        )
        for point, normal in zip(path, normals, strict=True)
    ]
    caps = [np.append(path[end], 0.0)[None] for end in (0, -1)]
    rings = [caps[0], *rings, caps[1]]
    corners = _ring_corners([len(ring) for ring in rings], around)
    along = np.concatenate([[[0.0]], 0.02 + 0.96 * t, [[1.0]]])
    uvs = np.stack(np.broadcast_arrays(along, np.linspace(0, 1, around + 1)), axis=-1)
    sheet = Sheet(corners.T, HANDLE_REGION.place(uvs).swapaxes(0, 1))
    return Body(np.concatenate(rings), [sheet], GLAZE)


def _rounded(span: Span) -> Float64Array:
    """Chaikin's corner cutting between fixed ends: (p, 2)."""
    points = np.array(span.control, dtype=np.float64)
    for _ in range(span.rounds):
        near, far = points[:-1], points[1:]
        cut = np.stack([0.75 * near + 0.25 * far, 0.25 * near + 0.75 * far], axis=1).reshape(-1, 2)
        points = np.concatenate([points[:1], cut[1:-1], points[-1:]])
    return points


def _angles(count: int) -> Float64Array:
    """Once around, the last angle equal to the first turn's end."""
    return np.linspace(0, 2 * np.pi, count + 1)


def _ring(radius: float, height: float, angles: Float64Array) -> Float64Array:
    """One vertex on the axis, else one an angle."""
    if radius == 0:
        return np.array([[0.0, height, 0.0]])
    return np.column_stack(
        [radius * np.cos(angles), np.full_like(angles, height), -radius * np.sin(angles)]
    )


def _ring_corners(sizes: Sequence[int], around: int) -> Int64Array:
    """(rings, around + 1) vertex indices; the last column closes each ring on its first vertex."""
    starts = np.cumsum([0, *sizes[:-1]])
    steps = np.arange(around + 1) % around
    return np.stack([start + steps % size for start, size in zip(starts, sizes, strict=True)])


def _lathe_uvs(profile: Float64Array, angles: Float64Array) -> Float64Array:
    """(rows, columns, 2) in [0, 1]^2: arc length against angle, or polar around the axis."""
    steps = np.linalg.norm(np.diff(profile, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(steps)]) / steps.sum()
    if profile[0, 0] > 0 and profile[-1, 0] > 0:
        band = np.broadcast_arrays(angles / (2 * np.pi), along[:, None])
        return np.stack(band, axis=-1)
    inwards = profile[-1, 0] == 0
    reach = 0.5 * (1 - along if inwards else along)[:, None]
    turn = np.append(angles[:-1], angles[0])
    sine = np.sin(turn) if inwards else -np.sin(turn)
    return 0.5 + np.stack([reach * np.cos(turn), reach * sine], axis=-1)
