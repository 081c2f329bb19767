"""The closest triangles are the same by the kernel, by libigl, and by looking at all of them."""

from __future__ import annotations

import tracemalloc

import numpy as np
import pytest

from nispcodec.core.arrays import Float64Array
from nispcodec.core.compiled import CompiledKernel, KernelError
from nispcodec.geometry.config import WindingConfig
from nispcodec.geometry.nearest import NearestTriangles
from nispcodec.geometry.triangles import apart
from nispcodec.geometry.winding import Winding
from nispcodec.infer.triangles import ROWS, squared_distances, triangle_rows
from tests.geometry.shapes import cube, hemisphere


@pytest.fixture(params=["kernel", "libigl"])
def engine(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(kernel: CompiledKernel) -> None:
        raise KernelError("none")

    if request.param == "libigl":
        monkeypatch.setattr(CompiledKernel, "best", missing)


def points(count: int) -> Float64Array:
    return np.random.default_rng(0).uniform(-1, 1, (count, 3))


@pytest.mark.usefixtures("engine")
def test_none_of_all_triangles_is_nearer() -> None:
    corners, asked = np.concatenate([cube((-0.5,) * 3, 0.6), hemisphere()]), points(300)
    found = NearestTriangles(corners).closest(asked)
    every = squared_distances(triangle_rows(corners)[:, None], asked.T[:, :, None])
    assert found.distances == pytest.approx(np.sqrt(every.min(axis=1)), abs=1e-12)
    at = np.einsum("nk,nkd->nd", found.weights, corners[found.faces])
    assert np.abs(at - found.positions).max() < 1e-12
    assert (found.weights >= 0).all()


@pytest.mark.usefixtures("engine")
def test_answers_keep_the_order_of_many_points() -> None:
    triangles, asked = NearestTriangles(cube((0, 0, 0), 1.0)), points(20_000)
    some = triangles.closest(asked[12_345:12_350])
    for name, values in vars(triangles.closest(asked)).items():
        assert np.array_equal(values[12_345:12_350], getattr(some, name)), name


@pytest.mark.usefixtures("engine")
def test_winding_numbers_of_either_kind_are_alike() -> None:
    corners, asked = np.concatenate([cube((-0.5,) * 3, 0.6), hemisphere()]), points(20_000)
    soup, none = apart(corners), apart(corners[:0])
    often, seldom = (Winding(*soup, WindingConfig(), often=each) for each in (True, False))
    assert np.abs(often.at(asked) - seldom.at(asked)).max() < 0.06
    assert Winding(*none, WindingConfig(), often=True).at(asked[:2]).tolist() == [0, 0]


def test_a_tree_takes_little_more_memory_than_what_it_holds() -> None:
    corners = np.random.default_rng(0).random((87_000, 3, 3))
    tracemalloc.start()
    NearestTriangles(corners)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 2 * ROWS * corners.itemsize * len(corners)
