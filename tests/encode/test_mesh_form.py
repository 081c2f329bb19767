from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from nispcodec.core.asset import Material
from nispcodec.core.document import Document, Frame
from nispcodec.core.progress import silent
from nispcodec.encode.config import FormConfig
from nispcodec.encode.mesh_form import MeshForm, Rest, coded_bytes
from nispcodec.geometry.analysis import analyze
from nispcodec.simplify.errors import Errors
from nispcodec.simplify.ladder import Candidate
from tests.geometry.shapes import box_asset, soup, sphere
from tests.simplify.scenes import copied, pebble

CONFIG = FormConfig()


@pytest.fixture(scope="module")
def ball() -> MeshForm:
    return MeshForm(analyze(soup(sphere(12))), 0, CONFIG, silent)


@pytest.fixture(scope="module")
def box() -> MeshForm:
    return MeshForm(analyze(box_asset()), 0, CONFIG, silent)


def test_a_nearer_surface_is_estimated_to_take_more_bytes(ball: MeshForm) -> None:
    estimates = [ball.estimate(distance, 300.0, 1e9) for distance in (7e-3, 4e-3, 1.5e-3)]
    assert estimates == sorted(set(estimates))
    assert ball.estimate(1e-12, 300.0, 700.0) >= 700


def test_the_estimate_is_near_what_is_found(ball: MeshForm) -> None:
    found = ball.within(4e-3, math.inf)
    assert found is not None
    assert found.errors.distance <= 4e-3
    assert 0.6 < ball.estimate(4e-3, 300.0, 1e9) / found.size < 1.6


def test_what_is_about_as_near_has_coarser_positions_or_finer_uvs(ball: MeshForm) -> None:
    ball.estimate(4e-3, 300.0, 1e9)
    found = ball.about(4e-3)
    ruled = ball.simplifier.balanced(found.asked)
    assert 2e-3 < found.errors.distance <= max(4e-3, ruled.errors.distance)
    assert found.bits <= ruled.bits
    assert found.uv_bits >= ruled.uv_bits


def test_nearer_triangles_are_taken_as_far_as_they_cost_less_and_have_the_bytes() -> None:
    dear = replace(CONFIG, distance_weight=10.0)
    form = MeshForm(analyze(soup(sphere(12))), 0, dear, silent)
    form.estimate(8e-3, 300.0, 1e9)
    found = form.about(8e-3)
    other = form.nearer(found, 8e-3, math.inf)
    assert other.errors.distance < 0.7 * found.errors.distance
    assert form.nearer(found, 8e-3, found.size) is found


def test_few_large_faces_are_kept_as_they_are(box: MeshForm) -> None:
    best = box.best(1e-3, math.inf)
    assert best.faces == 12
    assert best.errors.distance <= CONFIG.negligible
    assert best.size == coded_bytes(best.parts) < 150


def test_the_best_stays_within_both_limits(ball: MeshForm) -> None:
    free = ball.best(1.0, math.inf)
    near = ball.best(4e-3, math.inf)
    small = ball.best(1.0, 400.0)
    assert near.errors.distance <= 4e-3
    assert small.size <= 400
    assert min(near.size, free.size) >= small.size


def test_the_best_makes_up_and_loses_nothing_notable(ball: MeshForm) -> None:
    coarse = ball.fewest()
    assert not CONFIG.is_sound(coarse.errors)
    assert CONFIG.is_sound(ball.best(1.0, math.inf).errors)


def test_what_is_about_as_near_has_more_faces_where_it_makes_up_surface() -> None:
    analysis = analyze(soup(sphere(16)))

    def about(notable: float) -> Candidate:
        form = MeshForm(analysis, 0, replace(CONFIG, notable_far=notable), silent)
        form.estimate(6e-3, 300.0, 1e9)
        return form.about(6e-3)

    lax = about(1.0)
    strict = about(0.5 * lax.errors.made_up.share)
    assert strict.errors.made_up.share <= 0.5 * lax.errors.made_up.share
    assert lax.asked < strict.asked < 2 * lax.asked


def test_beside_networks_triangles_are_as_fine_as_the_whole_asks(ball: MeshForm) -> None:
    far = Errors(5e-3, 5e-3, 0.0, 0.0)
    found = ball.best_beside(Rest(3000.0, far, 0.5))
    assert CONFIG.is_sound(found.errors)
    # A nearer surface is worth more where there is more of it, and where many bytes are spent.
    assert found.size < ball.best_beside(Rest(3000.0, far, 0.9)).size
    assert found.size < ball.best_beside(Rest(30_000.0, far, 0.5)).size


def test_errors_of_a_document_are_those_of_what_it_decodes_to(ball: MeshForm) -> None:
    best = ball.best(4e-3, math.inf)
    frame = Frame((0.0, 0.0, 0.0), 1.0)
    document = Document(frame, (Material(),), (), meshes=best.parts)
    assert ball.errors(document).distance == pytest.approx(best.errors.distance, rel=0.05)


def test_materials_that_changed_places_are_another_color() -> None:
    one, other = Material("white"), Material("red", base_color=(1.0, 0.0, 0.0, 1.0))
    ball = soup(sphere(8))
    above = (ball.positions[ball.faces][..., 2].mean(axis=1) > 0).astype(np.int32)
    asset = replace(ball, materials=(one, other), face_materials=above)
    form = MeshForm(analyze(asset), 0, CONFIG, silent)
    parts, frame = form.best(4e-3, math.inf).parts, Frame((0.0, 0.0, 0.0), 1.0)
    swapped = tuple(replace(each, chart_materials=1 - each.chart_materials) for each in parts)
    right, wrong = (Document(frame, (one, other), (), meshes=each) for each in (parts, swapped))
    assert form.discolored(right).share == 0
    assert form.discolored(wrong).share > 0.9


def test_copies_are_held_once() -> None:
    analysis = analyze(copied(pebble()))
    form = MeshForm(analysis, 0, CONFIG, silent)
    best = form.best(1e-3, math.inf)
    assert [len(part.placements) for part in best.parts] == [4]
    document = Document(analysis.frame, (Material(),) * 4, (), meshes=best.parts)
    assert form.errors(document).distance == pytest.approx(best.errors.distance, rel=0.05)
