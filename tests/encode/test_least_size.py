"""The least size that a refusal names is one that can be had, and no smaller one is taken."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import nispcodec
from nispcodec import EncodeConfig, NispModel, TexturedMesh
from nispcodec.core.errors import TargetSizeError
from nispcodec.core.progress import silent
from nispcodec.encode.config import FormConfig
from nispcodec.format import pack
from nispcodec.simplify.config import FitConfig, LadderConfig
from tests.encode.tunings import small
from tests.geometry.shapes import box_asset, soup, sphere

pytestmark = pytest.mark.slow
FORMS = FormConfig(
    measured_faces=20_000,
    size_trials=2,
    ladder=LadderConfig(samples=2000, fit=FitConfig(rounds=2, uv_rounds=2, fewest=1000)),
)
SHORT = replace(small(3000, 60, 1, 100, 30, lambda_=1e-6), forms=FORMS)


def ball() -> TexturedMesh:
    return soup(sphere(8))


def encoded(mesh: TexturedMesh, size: float, geometry: str) -> NispModel:
    how = EncodeConfig("fast", geometry=geometry, target_size=size)
    return nispcodec.encode(mesh, how, silent, SHORT)


def least(mesh: TexturedMesh, size: float, geometry: str) -> int:
    """The size that a refusal names."""
    with pytest.raises(TargetSizeError) as refused:
        encoded(mesh, size, geometry)
    return refused.value.least


@pytest.mark.parametrize("shape", [box_asset, ball])
def test_the_least_size_can_be_had_and_is_that_of_the_smaller_form(
    shape: Callable[[], TexturedMesh],
) -> None:
    mesh = shape()
    found = {each: least(mesh, 1, each) for each in ("auto", "mesh", "field")}
    assert found["auto"] == min(found["mesh"], found["field"])
    assert least(mesh, found["auto"] - 1, "auto") == found["auto"]
    for geometry, size in found.items():
        assert len(pack(encoded(mesh, size, geometry).document)) <= size


def test_one_triangle_takes_all_of_the_least_size() -> None:
    mesh = soup(np.array([[[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]]))
    size = least(mesh, 1, "auto")
    assert len(pack(encoded(mesh, size, "auto").document)) == size
