from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.core.asset import TexturedMesh
from nispcodec.io.outliers import with_outliers_named


def grid(size: int = 40) -> TexturedMesh:
    """A square of `size` x `size` quads in [0, 1]^2, its UVs its positions."""
    x, y = np.meshgrid(*[np.linspace(0, 1, size + 1)] * 2)
    flat = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    first = (np.arange(size)[:, None] * (size + 1) + np.arange(size)).ravel()
    quad = np.stack([first, first + 1, first + size + 2, first + size + 1], axis=1)
    faces = np.concatenate([quad[:, [0, 1, 2]], quad[:, [0, 2, 3]]]).astype(np.int32)
    plain = TexturedMesh.geometry_only(flat, faces, "grid")
    return replace(plain, uvs=flat[:, :2].copy(), uv_faces=faces)


def with_speck(size: float, place: float, uv: float) -> TexturedMesh:
    """The grid and a triangle of its own."""
    mesh = grid()
    corners = np.array([[place, 0.0, 0], [place + size, 0, 0], [place, size, 0]])
    speck = np.arange(3, dtype=np.int32)[None]
    return replace(
        mesh,
        positions=np.vstack([mesh.positions, corners]),
        uvs=np.vstack([mesh.uvs, np.full((3, 2), uv)]),
        faces=np.vstack([mesh.faces, speck + len(mesh.positions)]),
        uv_faces=np.vstack([mesh.uv_faces, speck + len(mesh.uvs)]),
        face_materials=np.append(mesh.face_materials, np.int32(0)),
    )


def test_a_far_speck_is_named() -> None:
    (warning,) = with_outliers_named(with_speck(0.01, 1000, 0.5)).warnings
    assert warning.startswith("1 face(s) lie far from the others, which get 1/10")


def test_uvs_far_from_the_others_are_named() -> None:
    (warning,) = with_outliers_named(with_speck(0.01, 0.5, 1e4)).warnings
    assert warning.startswith("texture coordinates of 1 face(s) lie far from the others")


def test_moving_is_advised_only_where_it_helps() -> None:
    moved = with_speck(0.01, 0.5, 1e4)
    uvs = moved.uvs.copy()
    uvs[-1] += 60
    for mesh, words in (
        (moved, "move them by whole tiles"),
        (replace(moved, uvs=uvs), "one face runs over 60 tiles"),
    ):
        (warning,) = with_outliers_named(mesh).warnings
        assert words in warning


def test_few_large_faces_and_a_far_speck() -> None:
    mesh = with_speck(0.001, 50, 0.5)
    two = replace(
        mesh,
        positions=np.vstack([mesh.positions, [[0, 0, 0], [1, 0, 0], [1, 1, 0]]]),
        faces=np.vstack([np.arange(3) + len(mesh.positions), mesh.faces[-1]]).astype(np.int32),
        uv_faces=np.full((2, 3), -1, np.int32),
        face_materials=np.zeros(2, np.int32),
    )
    assert "1 face(s) lie far from the others" in with_outliers_named(two).warnings[0]
    alone = replace(
        two, faces=two.faces[:1], uv_faces=two.uv_faces[:1], face_materials=two.face_materials[:1]
    )
    assert with_outliers_named(alone).warnings == ()


def test_what_is_near_or_large_is_no_outlier() -> None:
    for mesh in (grid(), with_speck(0.01, 2, 5), with_speck(1, 1000, 0.5)):
        assert with_outliers_named(mesh).warnings == ()
    plain = replace(grid(), uvs=np.zeros((0, 2)), uv_faces=np.full_like(grid().faces, -1))
    assert with_outliers_named(plain).warnings == ()


def test_uvs_that_repeat_everywhere_are_no_outliers() -> None:
    mesh = grid()
    assert with_outliers_named(replace(mesh, uvs=mesh.uvs * 500)).warnings == ()
