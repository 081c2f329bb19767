"""Specks are what shows a wrong color where the original is smooth, and nothing else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.studies.specks import (
    Original,
    asked,
    in_sight,
    of_mesh,
    ratios,
    seen_points,
)
from nispcodec.core.asset import Texture, TexturedMesh
from nispcodec.core.texture import encode_image
from nispcodec.metrics.surface import Surface
from tests.metrics.shapes import plane, sphere

KNOWN = 40_000


def painted(dark: tuple[float, float]) -> TexturedMesh:
    """The unit square in white; the right half of its texture, which nothing shows, is black.

    Cells whose middle lies between `dark` along x look up that half.
    """
    pixels = np.full((64, 64, 4), 255, np.uint8)
    pixels[:, 32:, :3] = 0
    mesh = plane(cells=20)
    mesh = replace(
        mesh,
        uvs=np.concatenate([mesh.uvs * (0.4, 1) + (start, 0) for start in (0.05, 0.55)]),
        textures=(Texture("t.png", encode_image(pixels, "png", 0), "image/png"),),
    )
    middle = mesh.corners[:, :, 0].mean(axis=1)
    wrong = (middle > dark[0]) & (middle < dark[1])
    shifted = mesh.uv_faces + len(mesh.uvs) // 2 * wrong[:, None]
    return replace(mesh, uv_faces=shifted.astype(np.int32))


@pytest.fixture(scope="module")
def original() -> Original:
    return Original.of(painted((2, 2)), KNOWN)


def shares(original: Original, mesh: TexturedMesh) -> dict[str, float]:
    return of_mesh(original, Surface.of(mesh, original.frame), 20_000)


def test_a_perfect_decode_has_none(original: Original) -> None:
    found = shares(original, painted((2, 2)))
    assert found["mesh"] == 0.0
    assert found["smooth"] > 0.99


def test_a_tenth_of_the_surface_shows_a_wrong_color(original: Original) -> None:
    assert shares(original, painted((0.5, 0.6)))["mesh"] == pytest.approx(0.1, abs=0.01)


def test_another_color_beyond_a_seam_is_no_edge() -> None:
    half = Original.of(painted((0.5, 1)), KNOWN)
    found = shares(half, painted((0.5, 1)))
    assert found["smooth"] > 0.99
    assert found["mesh"] < 1e-3
    assert shares(half, painted((0.45, 1)))["mesh"] == pytest.approx(0.05, abs=0.01)


def test_an_edge_in_the_texture_is_not_smooth(original: Original) -> None:
    mesh = painted((2, 2))
    stretched = replace(mesh, uvs=mesh.uvs * (2.4, 1))
    assert 0.95 < shares(Original.of(stretched, KNOWN), stretched)["smooth"] < 1.0


def test_hidden_places_are_not_asked() -> None:
    outer, inner = sphere(1.0, 3), sphere(0.5, 3)
    count = len(outer.positions)
    both = replace(
        outer,
        positions=np.vstack([outer.positions, inner.positions]),
        faces=np.vstack([outer.faces, inner.faces + count]).astype(np.int32),
        uvs=np.full((2 * count, 2), 0.05),
        uv_faces=np.vstack([outer.faces, inner.faces + count]).astype(np.int32),
        face_materials=np.zeros(2 * len(outer.faces), np.int32),
    )
    seen = seen_points(Original.of(both, KNOWN), 2_000).positions
    assert len(seen) > 500
    assert np.linalg.norm(seen, axis=1).min() > 0.9


def test_a_layer_close_behind_others_is_not_in_sight() -> None:
    one = plane(cells=2)
    count = len(one.positions)
    layers = replace(
        one,
        positions=np.vstack([one.positions + np.array([0, 0, z]) for z in (0, 1e-4, 2e-4)]),
        faces=np.vstack([one.faces + i * count for i in range(3)]).astype(np.int32),
        uvs=np.vstack([one.uvs] * 3),
        uv_faces=np.vstack([one.uv_faces + i * len(one.uvs) for i in range(3)]).astype(np.int32),
        face_materials=np.tile(one.face_materials, 3),
    )
    surface = Surface.of(layers, Original.of(one, 100).frame)
    points = surface.sample(600, np.random.default_rng(0))
    layer = points.faces // len(one.faces)
    found = in_sight(surface, points)
    assert found[layer != 1].all()
    assert found[layer == 1].mean() < 0.1


def test_half_of_the_old_specks_are_asked_for() -> None:
    new, old = {"mesh": 1.1e-4, "queries": 0.0}, {"mesh": 2e-4, "queries": 0.0}
    assert verdicts(new, old) == ["missed", "met"]
    assert verdicts(new | {"mesh": 0.9e-4}, old) == ["met", "met"]
    assert verdicts(new, {}) == ["not measured", "met"]


def verdicts(new: dict[str, float], old: dict[str, float]) -> list[str]:
    return [each.verdict for each in asked({"assets": {"cup": {"ratios": ratios(new, old)}}})]
