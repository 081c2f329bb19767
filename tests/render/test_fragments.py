"""What every scene promises of the points that its rays hit."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest

from nispcodec.core.document import ChartTable
from nispcodec.metrics.surface import Surface
from nispcodec.render.field import FieldScene
from nispcodec.render.fragments import Fragments, Scene
from nispcodec.render.raycast import MeshScene
from tests import tiny
from tests.render.scenes import UNIT, square
from tests.tiny import field_of

COUNT = 60
TYPES = {
    "rays": ((), "int64"),
    "distances": ((), "float32"),
    "normals": ((3,), "float32"),
    "facing": ((), "bool"),
    "uvs": ((2,), "float32"),
    "jacobians": ((2, 3), "float32"),
    "materials": ((), "int32"),
    "textured": ((), "bool"),
    "charts": ((), "int32"),
}


def scene(name: str) -> Scene:
    if name == "mesh":
        return MeshScene(square(base_color=[[(255, 0, 0)]]), UNIT)
    plain = tiny.document()
    half = ChartTable(field_of(plain).charts.materials, np.array([True, False]))
    document = tiny.varied(plain, charts=half)
    return FieldScene(document, field_of(document))


@pytest.fixture(scope="module", params=["mesh", "field"])
def seen(request: pytest.FixtureRequest) -> tuple[Scene, np.ndarray, np.ndarray]:
    """A scene, and rays from all around of which some miss it."""
    random = np.random.default_rng(0)
    origins = random.normal(size=(COUNT, 3))
    origins *= 2 / np.linalg.norm(origins, axis=1, keepdims=True)
    towards = random.uniform(-0.6, 0.6, (COUNT, 3)) - origins
    towards /= np.linalg.norm(towards, axis=1, keepdims=True)
    return scene(request.param), origins.astype(np.float32), towards.astype(np.float32)


def test_every_field_has_its_shape_and_type(seen: tuple[Scene, np.ndarray, np.ndarray]) -> None:
    cast = seen[0].cast(*seen[1:], 0)
    found = cast.fragments
    assert {each.name for each in fields(found)} == set(TYPES)
    for name, (shape, kind) in TYPES.items():
        array = getattr(found, name)
        assert (name, array.shape, array.dtype.name) == (name, (len(found), *shape), kind)
    assert cast.steps.shape == cast.lost.shape == (COUNT,)
    assert (cast.steps.dtype.name, cast.lost.dtype.name) == ("int32", "bool")


def test_what_rays_find_is_in_their_order_and_before_them(
    seen: tuple[Scene, np.ndarray, np.ndarray],
) -> None:
    where, origins, towards = seen
    found = where.cast(origins, towards, 0).fragments
    assert 0 < len(found) < COUNT
    assert (np.diff(found.rays) > 0).all()
    assert (found.distances > 0).all()
    np.testing.assert_allclose(np.linalg.norm(found.normals, axis=1), 1, atol=1e-5)
    against = (found.normals * towards[found.rays]).sum(axis=1) < 0
    np.testing.assert_array_equal(found.facing, against)
    assert (found.materials < len(where.materials)).all()
    assert (found.uvs[~found.textured] == 0).all()
    assert (found.jacobians[~found.textured] == 0).all()
    # Within the surface: nothing changes along the normal.
    along = np.einsum("nkd,nd->nk", found.jacobians, found.normals)
    np.testing.assert_allclose(along, 0, atol=1e-3)


def test_a_choice_keeps_what_belongs_together(seen: tuple[Scene, np.ndarray, np.ndarray]) -> None:
    found = seen[0].cast(*seen[1:], 0).fragments
    chosen = found.rays % 2 == 0
    part = found[chosen]
    assert isinstance(part, Fragments)
    assert len(part) == chosen.sum()
    for each in fields(found):
        np.testing.assert_array_equal(
            getattr(part, each.name), getattr(found, each.name)[chosen], each.name
        )


def test_a_mesh_is_hit_on_its_surface() -> None:
    where = scene("mesh")
    assert isinstance(where, MeshScene)
    down = np.tile(np.array([0, 0, -1], np.float32), (5, 1))
    start = np.column_stack([np.linspace(-0.4, 0.4, 5), np.zeros(5), np.ones(5)])
    found = where.cast(start.astype(np.float32), down, 0).fragments
    surface: Surface = where.surface
    hit = start + found.distances[:, None] * down
    np.testing.assert_allclose(surface.closest(hit).positions, hit, atol=1e-6)
