"""Small meshes with known insides."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.core.asset import Material, TexturedMesh

CUBE_CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
SIDES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
CUBE_FACES = np.array([[a, *pair] for a, b, c, d in SIDES for pair in ((b, c), (c, d))])


def cube(low: tuple[float, float, float], size: float) -> Float64Array:
    """(12, 3, 3): the outward triangles of a cube."""
    return (CUBE_CORNERS * size + np.asarray(low))[CUBE_FACES]


def hemisphere(rings: int = 12) -> Float64Array:
    """The upper half of the unit sphere, open below, normals outwards."""
    u = np.linspace(0, 2 * np.pi, 2 * rings + 1)
    v = np.linspace(0, np.pi / 2, rings + 1)
    grid = np.stack(
        [
            np.outer(np.sin(v), np.cos(u)),
            np.outer(np.sin(v), np.sin(u)),
            np.tile(np.cos(v)[:, None], len(u)),
        ],
        axis=2,
    ).round(9)
    a, b, c, d = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    quads = np.stack([np.stack([a, b, c], 2), np.stack([a, c, d], 2)], 2).reshape(-1, 3, 3)
    size = np.linalg.norm(np.cross(quads[:, 1] - quads[:, 0], quads[:, 2] - quads[:, 0]), axis=1)
    return quads[size > 1e-9]


def sphere(rings: int = 12) -> Float64Array:
    """The unit sphere, normals outwards, as many rings in each half."""
    half = hemisphere(rings)
    return np.concatenate([half, (half * [1, 1, -1])[:, ::-1]])


def grid(count: int = 6) -> Float64Array:
    """The square [-1, 1]^2 at height 0, normals up, of count x count cells."""
    steps = np.linspace(-1, 1, count + 1)
    x, y = np.meshgrid(steps, steps, indexing="ij")
    spots = np.stack([x, y, np.zeros_like(x)], axis=2)
    a, b, c, d = spots[:-1, :-1], spots[1:, :-1], spots[1:, 1:], spots[:-1, 1:]
    return np.stack([np.stack([a, b, c], 2), np.stack([a, c, d], 2)], 2).reshape(-1, 3, 3)


def soup(triangles: Float64Array, uvs: Float64Array | None = None) -> TexturedMesh:
    """Triangles (m, 3, 3) with UVs (m, 3, 2), nothing shared by index; u, v = x, y by default."""
    indices = np.arange(3 * len(triangles), dtype=np.int32).reshape(-1, 3)
    corner_uvs = triangles[..., :2] if uvs is None else uvs
    return TexturedMesh(
        positions=triangles.reshape(-1, 3).copy(),
        faces=indices,
        uvs=corner_uvs.reshape(-1, 2).astype(np.float64),
        uv_faces=indices.copy(),
        face_materials=np.zeros(len(triangles), np.int32),
        materials=(Material("a"), Material("b")),
    )


def box_asset() -> TexturedMesh:
    """A cube whose six sides are six charts beside each other in a 3 x 2 atlas, two materials."""
    triangles = cube((-1, -1, -1), 2.0)
    uvs = np.empty((12, 3, 2))
    for side in range(6):
        flat = [
            axis for axis in range(3) if np.ptp(triangles[2 * side : 2 * side + 2, :, axis]) > 0
        ]
        local = (triangles[2 * side : 2 * side + 2][..., flat] + 1) / 2
        uvs[2 * side : 2 * side + 2] = (local * 0.9 + [side % 3, side // 3]) / [3, 2]
    mesh = soup(triangles, uvs)
    materials = np.repeat([0, 0, 0, 1, 1, 1], 2).astype(np.int32)
    return TexturedMesh(
        mesh.positions, mesh.faces, mesh.uvs, mesh.uv_faces, materials, mesh.materials
    )
