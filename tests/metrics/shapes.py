"""Small meshes with known distances between them."""

from __future__ import annotations

import dataclasses
import io

import numpy as np
import PIL.Image
import trimesh

from nispcodec.core.asset import Material, Texture, TexturedMesh, TextureMap


def plane(height: float = 0.0, cells: int = 8, name: str = "plane") -> TexturedMesh:
    """The unit square at z = height, as a grid; UV = (x, y)."""
    x, y = np.meshgrid(np.linspace(0, 1, cells + 1), np.linspace(0, 1, cells + 1))
    uvs = np.stack([x.ravel(), y.ravel()], axis=1)
    corner = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
    lower = np.stack([corner, corner + 1, corner + cells + 2], axis=1)
    upper = np.stack([corner, corner + cells + 2, corner + cells + 1], axis=1)
    positions = np.column_stack([uvs, np.full(len(uvs), height)])
    return textured(positions, np.vstack([lower, upper]), uvs, name)


def sphere(radius: float = 1.0, subdivisions: int = 4) -> TexturedMesh:
    """An icosphere; UV = the first two coordinates of the unit sphere, moved into [0, 1]."""
    ball = trimesh.creation.icosphere(subdivisions=subdivisions, radius=radius)
    return textured(ball.vertices, ball.faces, ball.vertices[:, :2] / radius / 2 + 0.5, "sphere")


def textured(positions: np.ndarray, faces: np.ndarray, uvs: np.ndarray, name: str) -> TexturedMesh:
    faces = np.asarray(faces, dtype=np.int32)
    return TexturedMesh(
        positions=np.array(positions, dtype=np.float64),
        faces=faces,
        uvs=np.array(uvs, dtype=np.float64),
        uv_faces=faces,
        face_materials=np.zeros(len(faces), dtype=np.int32),
        materials=(Material(maps={"base_color": TextureMap(0)}),),
        textures=(checkerboard(),),
        name=name,
    )


def checkerboard() -> Texture:
    tiles = np.kron(np.indices((8, 8)).sum(axis=0) % 2, np.ones((8, 8))).astype(np.uint8) * 255
    buffer = io.BytesIO()
    PIL.Image.fromarray(tiles).save(buffer, "PNG")
    return Texture("checker.png", buffer.getvalue(), "image/png")


def moved(mesh: TexturedMesh, offset: tuple[float, float, float]) -> TexturedMesh:
    return dataclasses.replace(mesh, positions=mesh.positions + np.asarray(offset))


def joined(first: TexturedMesh, second: TexturedMesh) -> TexturedMesh:
    """Both surfaces in one mesh, with the first one's material."""
    return textured(
        np.vstack([first.positions, second.positions]),
        np.vstack([first.faces, second.faces + len(first.positions)]),
        np.vstack([first.uvs, second.uvs]),
        first.name,
    )
