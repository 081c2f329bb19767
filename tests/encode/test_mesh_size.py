from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.progress import silent
from nispcodec.encode.config import FormConfig
from nispcodec.encode.mesh_form import MeshForm
from nispcodec.geometry.analysis import analyze
from tests.geometry.shapes import box_asset, grid, soup, sphere

CONFIG = FormConfig()


@pytest.fixture(scope="module")
def ball() -> MeshForm:
    return MeshForm(analyze(soup(sphere(12))), 0, CONFIG, silent)


def test_the_more_bytes_the_nearer_and_nearly_all_are_used(ball: MeshForm) -> None:
    sizes = (400, 600, 1200)
    found = [ball.of_size(most) for most in sizes]
    shares = [each.size / most for each, most in zip(found, sizes, strict=True)]
    assert all(0.9 < share <= 1 for share in shares)
    distances = [each.errors.distance for each in found]
    assert distances == sorted(distances, reverse=True)


def test_few_bytes_are_met_by_coarser_grids(ball: MeshForm) -> None:
    fewest = ball.fewest()
    coarse = ball.of_size(0.8 * fewest.size)
    assert coarse.size <= 0.8 * fewest.size
    assert coarse.bits < fewest.bits
    assert ball.of_size(1).bits == CONFIG.least_bits


def test_all_faces_are_taken_where_they_fit_on_grids_as_fine_as_there_is_room_for() -> None:
    box = MeshForm(analyze(box_asset()), 0, CONFIG, silent)
    coarse = box.simplifier.candidate(12, 6, 6)
    small, large = box.of_size(coarse.size + 20), box.of_size(500)
    assert small.faces == large.faces == 12
    assert small.bits + small.uv_bits < large.bits + large.uv_bits
    assert large.errors.distance <= CONFIG.negligible


def test_fewer_faces_are_taken_where_all_would_lie_on_coarse_grids() -> None:
    """Those of a slanted sheet, of which two triangles say all."""
    turned = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0]
    sheet = MeshForm(analyze(soup(grid(20) @ turned, grid(20)[..., :2])), 0, CONFIG, silent)
    everything = len(sheet.simplifier.source.triangles)
    bits = sheet.simplifier.bits_for(CONFIG.negligible, whole=True) + CONFIG.whole_bits[0][0]
    uv_bits = sheet.simplifier.uv_bits_for(CONFIG.negligible_uv)
    whole = sheet.simplifier.candidate(everything, bits, uv_bits)
    found = sheet.of_size(whole.size)
    assert found.faces < everything
    assert found.bits > whole.bits
    assert found.errors.distance < whole.errors.distance
