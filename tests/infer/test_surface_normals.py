from __future__ import annotations

import numpy as np

from nispcodec.infer.surface_normals import SurfaceNormals
from tests.infer.parts import cube, soup, sphere

CORNERS = np.eye(3)


def test_faces_have_normals_of_length_one_or_none() -> None:
    corners = np.concatenate([soup(5), np.zeros((1, 3, 3))])
    lengths = np.linalg.norm(SurfaceNormals(corners).faces, axis=1)
    np.testing.assert_allclose(lengths, [1, 1, 1, 1, 1, 0])


def test_of_a_cube() -> None:
    corners = cube()
    normals = SurfaceNormals(corners)
    faces = np.arange(12, dtype=np.int32)
    inside = normals.at(faces, np.full((12, 3), 1 / 3))
    np.testing.assert_allclose(np.abs(inside).max(axis=1), 1)
    assert (np.sign(inside) * corners.mean(axis=1) >= 0).all()
    for corner in range(3):
        at = normals.at(faces, np.repeat(CORNERS[corner : corner + 1], 12, axis=0))
        np.testing.assert_allclose(at, np.sign(corners[:, corner]) / 3**0.5)
    for start in range(3):
        weights = (CORNERS[start] + CORNERS[(start + 1) % 3]) / 2
        middle = weights @ corners
        expected = np.where(np.abs(middle) > 0.4, np.sign(middle), 0)
        expected /= np.linalg.norm(expected, axis=1, keepdims=True)
        np.testing.assert_allclose(
            normals.at(faces, np.repeat(weights[None], 12, axis=0)), expected, atol=1e-12
        )


def test_corners_of_a_round_body_point_away_from_its_middle() -> None:
    corners = sphere(40)
    normals = SurfaceNormals(corners)
    numbers = np.arange(len(corners), dtype=np.int32)
    at = normals.at(numbers, np.repeat(CORNERS[:1], len(corners), axis=0))
    away = corners[:, 0] / np.linalg.norm(corners[:, 0], axis=1, keepdims=True)
    assert ((at * away).sum(axis=1) > 0.999).all()


def test_between_two_faces_back_to_back_it_is_the_face_s_own() -> None:
    face = soup(1)
    both = SurfaceNormals(np.concatenate([face, face[:, ::-1]]))
    asked = np.array([0, 1, 0], np.int32), np.array([[0.5, 0.5, 0], [1, 0, 0], [0, 0, 1]])
    np.testing.assert_allclose(both.at(*asked), both.faces[[0, 1, 0]])
