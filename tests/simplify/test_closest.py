"""Closest points on triangles."""

from __future__ import annotations

import numpy as np

from nispcodec.simplify.closest import Tree, unit
from nispcodec.simplify.samples import sample_count, spread
from tests.simplify.meshes import SMALL_FIT, ball, sheet


def test_a_point_outside_a_sphere_comes_to_its_foot() -> None:
    tree = Tree(ball().corners)
    points = unit(np.random.default_rng(0).normal(size=(200, 3))) * 2
    hits = tree.closest(points)
    assert np.linalg.norm(hits.positions - points / 2, axis=1).max() < 0.1
    assert np.allclose(hits.interpolate(tree.corners), hits.positions)


def test_faces_without_area_are_never_the_closest() -> None:
    corners = np.concatenate([np.zeros((1, 3, 3)), sheet().corners])
    hits = Tree(corners).closest(np.zeros((1, 3)))
    assert hits.faces[0] > 0
    assert np.isfinite(hits.weights).all()


def test_points_are_spread_evenly_over_the_area() -> None:
    tree = Tree(ball().corners)
    hits = spread(tree, 5000, np.random.default_rng(0))
    counts = np.bincount(hits.faces, minlength=len(tree.areas))
    wanted = 5000 * tree.areas / tree.areas.sum()
    assert np.abs(counts - wanted).max() < 2
    assert np.allclose(hits.interpolate(tree.corners), hits.positions)


def test_few_and_many_vertices_have_bounds() -> None:
    assert sample_count(3, SMALL_FIT) == SMALL_FIT.fewest
    assert sample_count(10**6, SMALL_FIT) == SMALL_FIT.most
