"""Groups as parts: in a file, asked, and of few faces."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from nispcodec.core.arrays import Float64Array
from nispcodec.core.asset import Material
from nispcodec.core.document import Document, Frame
from nispcodec.core.mesh_part import MeshPart
from nispcodec.core.placing import placed_points
from nispcodec.format import mesh
from nispcodec.model import NispModel
from nispcodec.simplify.config import CopiesConfig, RoundingConfig
from nispcodec.simplify.copies import Copies
from nispcodec.simplify.copy_search import copies_of
from nispcodec.simplify.quantize import Grid, quantized
from nispcodec.simplify.triangles import Triangles
from tests.simplify.meshes import area, ball, simplifier, triangles_of
from tests.simplify.scenes import PLACES, copied, pebble

SCENE = triangles_of(copied(pebble()))
COPIES = copies_of(SCENE, CopiesConfig())
BITS = 12


def parts_of(
    copies: Copies, triangles: Triangles, bits: int = BITS, uv_bits: int = BITS
) -> tuple[MeshPart, ...]:
    grids = Grid.of(triangles.positions, bits), Grid.of(triangles.uvs, uv_bits)
    return copies.parts(triangles, *grids)


def asked(parts: tuple[MeshPart, ...], points: Float64Array) -> NispModel:
    frame = Frame((0.0, 0.0, 0.0), 1.0)
    return NispModel(Document(frame, (Material(),) * 4, (), meshes=parts))


def points_about() -> Float64Array:
    rng = np.random.default_rng(0)
    near = SCENE.corners.mean(axis=1) + rng.normal(0, 0.01, (len(SCENE), 3))
    return np.concatenate([near, rng.uniform(-1, 1, (200, 3))])


def test_answers_are_those_of_the_asset_without_copies() -> None:
    held = mesh.decode(mesh.encode(parts_of(COPIES, COPIES.triangles)))
    whole = mesh.decode(mesh.encode(parts_of(Copies.none(SCENE), SCENE)))
    points, step = points_about(), whole[0].step
    copied_sdf, plain_sdf = asked(held, points).sdf(points), asked(whole, points).sdf(points)
    np.testing.assert_allclose(copied_sdf, plain_sdf, atol=2 * step)
    surface = points[: len(SCENE)]
    one, other = asked(held, surface).uv(surface), asked(whole, surface).uv(surface)
    assert np.median(np.abs(one - other)) < 2e-3


def test_four_copies_take_less_than_half_of_the_bytes() -> None:
    held = len(mesh.encode(parts_of(COPIES, COPIES.triangles)))
    whole = len(mesh.encode(parts_of(Copies.none(SCENE), SCENE)))
    assert held < 0.5 * whole


def test_materials_of_a_copy_are_those_of_its_charts() -> None:
    (part,) = parts_of(COPIES, COPIES.triangles)
    own = [each.materials for each in part.placements if each.materials is not None]
    assert len(own) == 1
    assert own[0].tolist() == (part.chart_materials + 2).tolist()


def test_a_part_of_all_is_the_quantized_one() -> None:
    triangles = ball()
    (part,) = parts_of(Copies.none(triangles), triangles, 10, 9)
    assert mesh.encode((part,)) == mesh.encode((quantized(triangles, 10, 9),))


def test_scene_has_all_copies() -> None:
    scene = COPIES.scene(COPIES.triangles)
    assert len(scene.faces) == len(SCENE)
    assert np.sort(scene.corners.sum(axis=(1, 2))) == pytest.approx(
        np.sort(SCENE.corners.sum(axis=(1, 2))), abs=1e-9
    )
    assert len(PLACES) == 4


def test_candidates_are_measured_against_all_copies() -> None:
    made = simplifier(SCENE)
    whole, fewer = made.balanced(len(made.source.triangles)), made.balanced(90)
    assert whole.errors.distance < 2e-4
    assert fewer.errors.distance < 0.02
    assert fewer.size < whole.size
    assert whole.faces == len(SCENE) // 4


def test_copies_of_which_few_faces_are_left_are_faces_like_others() -> None:
    few = replace(COPIES, fewest_left=len(COPIES.triangles) + 1)
    (part,) = parts_of(few, COPIES.triangles)
    (held,) = parts_of(COPIES, COPIES.triangles)
    assert len(part.faces) == len(SCENE)
    assert len(part.placements) == 1
    assert set(part.chart_materials.tolist()) == {0, 1, 2, 3}
    points = points_about()
    ours, theirs = asked((part,), points).sdf(points), asked((held,), points).sdf(points)
    np.testing.assert_allclose(ours, theirs, atol=2 * part.step)


def test_bodies_are_simplified_with_the_area_of_all_their_copies() -> None:
    assert area(COPIES.triangles) == pytest.approx(area(SCENE), rel=1e-6)
    home = COPIES.groups[0].home(COPIES.triangles)
    assert area(home) == pytest.approx(area(SCENE) / COPIES.groups[0].weight ** 2, rel=1e-6)


def test_rounded_positions_stay_as_they_are_in_parts() -> None:
    grid = Grid.of(COPIES.triangles.positions, BITS)
    rounded = COPIES.rounded(COPIES.triangles, grid, RoundingConfig(), 0)
    (part,) = COPIES.parts(rounded, grid, Grid.of(rounded.uvs, BITS))
    home = COPIES.groups[0].home(rounded)
    np.testing.assert_allclose(part.normalized()[part.faces], home.corners, atol=1e-6)


def test_vertices_are_found_where_a_copy_of_them_stands() -> None:
    given, places = COPIES.triangles, COPIES.groups[0].placements
    home = COPIES.groups[0].home(given).positions
    for placement in places:
        found = COPIES.vertices_at(placed_points(placement, home[[3, 8]]), 1e-6)
        assert np.flatnonzero(found).tolist() == [3, 8]
    assert not COPIES.vertices_at(np.array([[0.0, 0.0, 3.0]]), 1e-6).any()
