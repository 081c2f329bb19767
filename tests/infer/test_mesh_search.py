from __future__ import annotations

import tracemalloc

import numpy as np
import pytest

from nispcodec.core.arrays import BoolArray
from nispcodec.core.compiled import CompiledKernel, KernelError
from nispcodec.infer.mesh_search import MeshSearch, SearchConfig
from tests.infer.parts import cube, points_about, points_off, soup

IN_NUMPY = SearchConfig(kernel=False)


def sheets(count: int, share: int = 4) -> BoolArray:
    return np.arange(count) % share == 0


def test_answers_are_the_same_with_and_without_the_kernel() -> None:
    corners = np.concatenate([cube(), soup(200)])
    points = points_about(corners, 5000)
    ours, plain = (MeshSearch(corners, sheets(212), each) for each in (SearchConfig(), IN_NUMPY))
    for found, expected in zip(ours.closest(points), plain.closest(points), strict=True):
        np.testing.assert_array_equal(found, expected)
    off = points_off(corners, 5000)
    assert (ours.inside(off) == plain.inside(off)).mean() > 0.999


def test_a_machine_without_a_kernel_answers_all_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(kernel: CompiledKernel) -> None:
        raise KernelError("none")

    monkeypatch.setattr(CompiledKernel, "best", missing)
    search = MeshSearch(cube(), np.zeros(12, np.bool_))
    assert search.inside(np.array([[0.0, 0, 0], [1, 0, 0]])).tolist() == [True, False]


@pytest.mark.parametrize("config", [SearchConfig(), IN_NUMPY], ids=["kernel", "numpy"])
def test_answers_do_not_depend_on_the_other_points(config: SearchConfig) -> None:
    corners = soup(100)
    search = MeshSearch(corners, np.zeros(100, np.bool_), config)
    points = points_about(corners, 600).astype(np.float32)
    faces, squared = search.closest(points)
    order = np.random.default_rng(0).permutation(len(points))
    np.testing.assert_array_equal(search.closest(points[order])[0], faces[order])
    np.testing.assert_array_equal(search.closest(points[order])[1], squared[order])
    np.testing.assert_array_equal(search.inside(points[order]), search.inside(points)[order])
    np.testing.assert_array_equal(search.closest(points[5:6])[0], faces[5:6])


def test_large_meshes_answer_as_small_ones() -> None:
    corners = soup(300)
    points = points_about(corners, 3000)
    small = MeshSearch(corners, sheets(300))
    large = MeshSearch(corners, sheets(300), SearchConfig(large=100, more=500))
    for found, expected in zip(large.closest(points), small.closest(points), strict=True):
        np.testing.assert_array_equal(found, expected)
    np.testing.assert_array_equal(large.inside(points), small.inside(points))


def test_memory_is_bounded_beyond_input_and_output() -> None:
    search = MeshSearch(soup(50), np.zeros(50, np.bool_), IN_NUMPY)
    points = np.random.default_rng(0).uniform(-1, 1, (30_000, 3)).astype(np.float32)
    tracemalloc.start()
    search.closest(points)
    search.inside(points)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 30_000 * (4 + 8 + 1) + 32e6
