from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nispcodec.core.arrays import Float32Array
from nispcodec.core.asset import Material, TextureMap
from nispcodec.core.errors import MeshError
from nispcodec.render.fragments import Fragments
from nispcodec.render.maps import Maps
from nispcodec.render.shade import DIELECTRIC, ENVIRONMENT, LAMP, Look, looks, shaded
from tests.render.scenes import texture

UP = np.array([0, 0, 1], np.float32)
SHARE = st.floats(0, 1, width=32)


def look(**changes: Any) -> Look:
    """One point of white, rough plaster that faces up."""
    every: dict[str, Any] = {
        "base": (1, 1, 1),
        "emissive": (0, 0, 0),
        "normals": (0, 0, 1),
        "alpha": 1,
        "metallic": 0,
        "roughness": 1,
        "occlusion": 1,
    }
    return Look(**{k: np.array([v], np.float32) for k, v in (every | changes).items()})


def light(lamp: Any = UP, towards: Any = -UP, **changes: Any) -> Float32Array:
    """(3,): what a look sends to the eye."""
    found = shaded(look(**changes), np.array([towards], np.float32), np.array(lamp, np.float32))
    assert (found.shape, found.dtype.name) == ((1, 3), "float32")
    return found[0]


def test_behind_the_lamp_only_the_environment_shines_and_not_into_crevices() -> None:
    even = ENVIRONMENT * (0.5 + DIELECTRIC)
    np.testing.assert_allclose(light(-UP, base=(0.5,) * 3), even, rtol=1e-6)
    np.testing.assert_allclose(light(-UP, base=(0.5,) * 3, occlusion=0), 0, atol=1e-7)


@given(SHARE, SHARE, SHARE, st.floats(0, 3))
def test_emission_is_added_whatever_else_there_is(
    base: float, metallic: float, roughness: float, glow: float
) -> None:
    each = {"base": (base,) * 3, "metallic": metallic, "roughness": roughness}
    dark, bright = light(**each), light(**each, emissive=(glow, 0, 0))
    np.testing.assert_allclose(bright - dark, (glow, 0, 0), atol=1e-4 * (1 + dark.max()))
    assert dark.min() >= 0


def test_plaster_is_as_bright_from_everywhere_but_for_its_gloss() -> None:
    """Lambert: by the cosine of the lamp's angle; gloss is DIELECTRIC / 4 at most when rough."""
    slant = np.array([0, np.sin(1.0), np.cos(1.0)])
    spread = np.array([light(slant, -np.array([np.sin(a), 0, np.cos(a)])) for a in (0, 0.5, 1.2)])
    wanted = LAMP * np.cos(1.0) + ENVIRONMENT * (1 + DIELECTRIC)
    assert np.abs(spread - wanted).max() <= DIELECTRIC / 4
    assert spread.min() >= wanted


def test_metal_shines_in_its_own_color_and_plastic_in_that_of_the_lamp() -> None:
    red = (1.0, 0.0, 0.0)
    metal, plastic = (light(base=red, metallic=m, roughness=0.2) for m in (1, 0))
    assert metal[0] > 10 > metal[1] == metal[2] == 0
    assert plastic[1] == plastic[2] > 0.5
    # Metal does nothing but mirror.
    np.testing.assert_allclose(light(-UP, base=red, metallic=1), ENVIRONMENT * np.array(red))


@pytest.mark.parametrize("roughness", [0.3, 0.6, 1.0])
def test_a_highlight_is_where_a_mirror_would_show_the_lamp(roughness: float) -> None:
    angle = 0.6
    lamp = (np.sin(angle), 0, np.cos(angle))
    views = np.linspace(-1.2, 1.2, 49)
    metal = {"base": (1, 1, 1), "metallic": 1, "roughness": roughness}
    seen = [light(lamp, (-np.sin(v), 0, -np.cos(v)), **metal)[0] for v in views]
    brightest = views[int(np.argmax(seen))]
    assert np.ptp(seen) < 1e-6 if roughness == 1 else brightest == pytest.approx(-angle, abs=0.05)


def fragments(count: int, materials: Any, textured: Any = True) -> Fragments:
    """Points that face the viewer, with u along x and v along y."""
    return Fragments(
        rays=np.arange(count),
        distances=np.ones(count, np.float32),
        normals=np.tile(UP, (count, 1)),
        facing=np.ones(count, np.bool_),
        uvs=np.full((count, 2), 0.5, np.float32),
        jacobians=np.tile(np.eye(2, 3, dtype=np.float32), (count, 1, 1)),
        materials=np.broadcast_to(np.array(materials, np.int32), count).copy(),
        textured=np.broadcast_to(np.array(textured, np.bool_), count).copy(),
        charts=np.full(count, -1, np.int32),
    )


def only_look(points: Fragments, material: Material, *pixels: Any, **options: Any) -> Look:
    """The look of points that all are of one kind."""
    maps = Maps(tuple(texture([[each]]) for each in pixels))
    tiny = np.full(len(points), 1e-3, np.float32)
    ((chosen, found),) = looks(points, (material,), maps, tiny, **options)
    assert chosen.all()
    return found


def test_every_point_has_one_look_that_of_its_material() -> None:
    red, blue = Material(base_color=(1, 0, 0, 1)), Material(base_color=(0, 0, 1, 1))
    points = fragments(6, [0, 1, 1, 0, 1, 0], [True, False, True, True, True, False])
    times, base = np.zeros(6), np.zeros((6, 3))
    for chosen, found in looks(points, (red, blue), Maps(()), np.ones(6, np.float32)):
        times += chosen
        base[chosen] = found.base
        assert len(found.normals) == chosen.sum()
    assert (times == 1).all()
    np.testing.assert_array_equal(base[:, 2], points.materials)


def test_factors_multiply_texels_and_stand_alone_without_uv() -> None:
    used = {"base_color": TextureMap(0), "metallic_roughness": TextureMap(1)}
    material = Material(base_color=(0.5, 1, 1, 1), metallic=0.5, roughness=0.5, maps=used)
    pixels = ((255, 0, 255), (0, 51, 102))
    found = only_look(fragments(1, 0), material, *pixels)
    np.testing.assert_allclose(found.base[0], (0.5, 0, 1), atol=1e-6)
    np.testing.assert_allclose((found.roughness[0], found.metallic[0]), (0.1, 0.2), atol=1e-6)
    alone = only_look(fragments(1, 0, textured=False), material, *pixels)
    np.testing.assert_allclose(alone.base[0], (0.5, 1, 1))
    assert (alone.roughness[0], alone.metallic[0]) == (0.5, 0.5)


@pytest.mark.parametrize(("strength", "wanted"), [(0.0, 1.0), (0.5, 0.7), (1.0, 0.4)])
def test_occlusion_has_a_strength(strength: float, wanted: float) -> None:
    material = Material(maps={"occlusion": TextureMap(0, strength=strength)})
    found = only_look(fragments(1, 0), material, (102, 0, 0))
    assert found.occlusion[0] == pytest.approx(wanted, abs=1e-6)


@pytest.mark.parametrize(
    ("mode", "alpha", "wanted"),
    [
        ("opaque", 0.2, 1),
        ("blend", 0.25, 0.25),
        ("mask", 0.6, 1),
        ("mask", 0.59, 0),
    ],
)
def test_alpha_is_what_the_mode_makes_of_it(mode: str, alpha: float, wanted: float) -> None:
    material = Material(base_color=(1, 1, 1, alpha), alpha_mode=mode, alpha_cutoff=0.6)
    assert only_look(fragments(1, 0), material).alpha[0] == wanted


@pytest.mark.parametrize("strength", [0.0, 0.5, 2.0])
def test_a_normal_map_leans_by_its_strength_and_stays_a_unit(strength: float) -> None:
    material = Material(maps={"normal": TextureMap(0, strength=strength)})
    found = only_look(fragments(1, 0), material, (204, 128, 255)).normals[0]
    wanted = np.array([0.6 * strength, 0, 1])
    np.testing.assert_allclose(found, wanted / np.linalg.norm(wanted), atol=0.01)
    plain = only_look(fragments(1, 0), material, (204, 128, 255), normal_map=False)
    np.testing.assert_array_equal(plain.normals[0], UP)


def test_from_behind_normals_are_turned_to_the_viewer() -> None:
    behind = replace(fragments(2, 0), facing=np.array([False, False]))
    np.testing.assert_array_equal(only_look(behind, Material()).normals, [-UP, -UP])


def test_a_texture_that_does_not_decode_is_named() -> None:
    broken = replace(texture([[(0, 0, 0)]], "broken.png"), data=b"no image")
    material = Material(maps={"emissive": TextureMap(0)})
    with pytest.raises(MeshError, match=r"texture broken\.png: expected an image"):
        list(looks(fragments(1, 0), (material,), Maps((broken,)), np.ones(1, np.float32)))
