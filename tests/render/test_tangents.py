from __future__ import annotations

import numpy as np
import pytest

from nispcodec.render.tangents import tangent_axes, tangent_frames

NORMALS = np.random.default_rng(0).normal(size=(200, 3)).astype(np.float32)
NORMALS /= np.linalg.norm(NORMALS, axis=1, keepdims=True)
NORMALS[0] = (0, 0, -1)


def test_tangent_axes_complete_a_right_handed_frame() -> None:
    first, second = tangent_axes(NORMALS)
    frames = np.stack([first, second, NORMALS], axis=1)
    np.testing.assert_allclose(
        frames @ frames.transpose(0, 2, 1), np.tile(np.eye(3), (200, 1, 1)), atol=1e-6
    )
    np.testing.assert_allclose(np.linalg.det(frames), 1, atol=1e-5)


@pytest.mark.parametrize("mirrored", [False, True])
def test_tangents_follow_u_and_bitangents_the_side_of_v(mirrored: bool) -> None:
    first, second = tangent_axes(NORMALS)
    u = 0.7 * (-first if mirrored else first)
    v = 0.2 * first + 1.5 * second
    tangents, bitangents = tangent_frames(NORMALS, np.stack([u, v], axis=1))
    assert ((tangents * u).sum(axis=1) > 0).all()
    np.testing.assert_allclose((tangents * v).sum(axis=1), 0, atol=1e-5)
    assert ((bitangents * v).sum(axis=1) > 0).all()
    handed = (np.cross(tangents, bitangents) * NORMALS).sum(axis=1)
    np.testing.assert_allclose(handed, -1 if mirrored else 1, atol=1e-5)


def test_without_a_jacobian_the_frame_is_still_one() -> None:
    tangents, bitangents = tangent_frames(NORMALS, np.zeros((200, 2, 3), np.float32))
    np.testing.assert_allclose(np.linalg.norm(tangents, axis=1), 1, atol=1e-5)
    np.testing.assert_allclose((tangents * NORMALS).sum(axis=1), 0, atol=1e-5)
    np.testing.assert_allclose((tangents * bitangents).sum(axis=1), 0, atol=1e-5)
