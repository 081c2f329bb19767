"""Weighted least squares of vertices."""

from __future__ import annotations

import numpy as np

from nispcodec.simplify.config import SolverConfig
from nispcodec.simplify.least_squares import Pull, pulled

EXACT = SolverConfig(steps=200, tolerance=1e-12)


def test_pulls_all_ways_are_least_squares() -> None:
    rng = np.random.default_rng(0)
    vertices = rng.integers(0, 6, (60, 3))
    means = rng.random((60, 3))
    targets, weights = rng.normal(size=(60, 2)), rng.random(60)
    found = pulled(np.zeros((6, 2)), [Pull(vertices, means, targets, weights)], 0.0, EXACT)
    matrix = np.zeros((60, 6))
    np.add.at(matrix, (np.arange(60)[:, None], vertices), means)
    root = np.sqrt(weights)[:, None]
    wanted = np.linalg.lstsq(root * matrix, root * targets, rcond=None)[0]
    assert np.allclose(found, wanted)


def test_a_pull_in_one_direction_leaves_the_others() -> None:
    start = np.array([[1.0, 2.0, 3.0]])
    pull = Pull(
        np.zeros((1, 1), np.int64),
        np.ones((1, 1)),
        np.array([[5.0, 5.0, 5.0]]),
        np.ones(1),
        np.array([[0.0, 0.0, 1.0]]),
        sliding=0.0,
    )
    assert np.allclose(pulled(start, [pull], 1e-9, EXACT), [[1, 2, 5]])


def test_a_vertex_without_points_stays() -> None:
    start = np.array([[1.0, 2.0], [3.0, 4.0]])
    pull = Pull(np.zeros((1, 1), np.int64), np.ones((1, 1)), np.array([[7.0, 7.0]]), np.ones(1))
    found = pulled(start, [pull], 0.01, EXACT)
    assert np.allclose(found[1], start[1])
    assert np.allclose(found[0], 7, atol=0.1)
