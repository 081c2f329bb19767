from __future__ import annotations

import numpy as np

from nispcodec.io.read.coordinates import without_unusable, without_unused

NAN, INF = np.nan, np.inf


def test_positions_that_no_corner_uses_become_zero_and_are_counted_once() -> None:
    positions = np.array([[0.0, 1, 2], [NAN, 0, 0], [3, 4, 5], [0, -INF, 0]])
    warnings: list[str] = []
    for _ in range(2):
        kept = without_unused(positions, np.array([0, 2]), "a: b", warnings)
        assert kept.tolist() == [[0, 1, 2], [0, 0, 0], [3, 4, 5], [0, 0, 0]]
    assert warnings == ["a: b: left out 2 vertices without finite coordinates, which no face has"]


def test_positions_that_a_corner_uses_stay_as_they_are() -> None:
    positions = np.array([[0.0, 1, 2], [NAN, 0, 0]])
    warnings: list[str] = []
    kept = without_unused(positions, np.array([0, 1]), "a", warnings)
    np.testing.assert_array_equal(kept, positions)
    assert warnings == []


def test_faces_with_unusable_uvs_lose_them() -> None:
    uvs = np.array([[0.0, 1], [NAN, 0.5], [1, 1]])
    warnings: list[str] = []
    kept, faces = without_unusable(
        uvs, np.array([[0, 2, 2], [0, 1, 2], [-1, -1, -1]]), "a", warnings
    )
    assert kept.tolist() == [[0, 1], [0, 0.5], [1, 1]]
    assert faces.tolist() == [[0, 2, 2], [-1, -1, -1], [-1, -1, -1]]
    assert warnings == ["a: texture coordinates of 1 face(s) are no finite numbers: left out"]
