from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from nispcodec.bake.maps import baked_maps, further_slots
from nispcodec.bake.tangents import TangentFrames
from nispcodec.core.arrays import Float64Array
from nispcodec.core.asset import Material, TextureMap
from nispcodec.core.document import ChartTable
from nispcodec.core.errors import MeshError
from nispcodec.core.slots import SLOTS
from nispcodec.model import NispModel
from tests import tiny
from tests.tiny import field_of, varied

EVERY = {slot: TextureMap(0, strength=0.5) for slot in SLOTS}


def model(*materials: Material, texel: Any = (204, 102, 255), has_uv: Any = True) -> NispModel:
    """Two charts beside each other, left and right, of the first and the second material."""
    plain = tiny.document()
    charts = ChartTable(
        field_of(plain).charts.materials, np.broadcast_to(np.array(has_uv), 2).copy()
    )
    image = tiny.png(np.array([[texel]], np.uint8))
    return NispModel(varied(plain, charts=charts, materials=materials, textures=(image,)))


def ask(asked: NispModel) -> tuple[Float64Array, TangentFrames]:
    """A point on the left and one on the right, in the world; the old UV grows along y and z."""
    points = asked.document.frame.to_world(np.array([[-0.4, 0.1, 0.2], [0.4, 0.1, 0.2]]))
    along, up = (np.tile(axis, (2, 1)) for axis in np.eye(3)[1:])
    return points, TangentFrames(along, up)


def test_slots_are_those_of_any_material_in_the_order_of_the_table() -> None:
    first = Material(maps={"emissive": TextureMap(0), "base_color": TextureMap(0)})
    second = Material(maps={"normal": TextureMap(0)})
    assert further_slots(model(first, second)) == ("normal", "emissive")
    plain = model(Material(), Material())
    assert further_slots(plain) == ()
    assert baked_maps(plain, *ask(plain)) == {}


def test_every_slot_has_a_texel_for_every_point() -> None:
    asked = model(Material(maps=EVERY), Material("bare"))
    baked = baked_maps(asked, *ask(asked))
    assert list(baked) == list(SLOTS[1:])
    for texels in baked.values():
        assert (texels.shape, texels.dtype.name) == ((2, 3), "float32")
        assert ((texels >= 0) & (texels <= 1)).all()


def test_a_material_without_a_map_shows_its_factors_beside_one_that_has_it() -> None:
    factors: dict[str, Any] = {"metallic": 0.25, "roughness": 0.5, "emissive": (1.0, 0.0, 0.0)}
    asked = model(Material(maps=EVERY, **factors), Material("bare", **factors))
    baked = baked_maps(asked, *ask(asked))
    wanted = {
        "metallic_roughness": ((0.8, 0.2, 0.25), (1, 0.5, 0.25)),
        "occlusion": ((0.9, 0.7, 1), (1, 1, 1)),
        "emissive": ((0.8, 0, 0), (1, 0, 0)),
        "normal": (None, (0.5, 0.5, 1)),
    }
    for slot, rows in wanted.items():
        for found, row in zip(baked[slot], rows, strict=True):
            if row is not None:
                np.testing.assert_allclose(found, row, atol=1e-5, err_msg=slot)


def test_a_chart_without_uv_shows_its_factors_too() -> None:
    material = Material(metallic=0.25, roughness=0.5, maps=EVERY)
    asked = model(material, material, has_uv=[True, False])
    baked = baked_maps(asked, *ask(asked))
    np.testing.assert_allclose(baked["metallic_roughness"][1], (1, 0.5, 0.25), atol=1e-6)
    np.testing.assert_allclose(baked["normal"][1], (0.5, 0.5, 1), atol=1e-6)
    assert abs(baked["normal"][0, 0] - 0.5) > 0.1


@pytest.mark.parametrize("strength", [0.0, 0.5, 1.0])
def test_normals_are_units_that_lean_by_the_strength(strength: float) -> None:
    used = {"normal": TextureMap(0, strength=strength)}
    asked = model(Material(maps=used), Material(maps=used))
    normals = 2 * baked_maps(asked, *ask(asked))["normal"] - 1
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-5)
    wanted = np.array([0.6 * strength, -0.2 * strength, 1])
    np.testing.assert_allclose(normals, [wanted / np.linalg.norm(wanted)] * 2, atol=1e-3)


@pytest.mark.parametrize("angle", [0.5, 2.0, -1.0])
@pytest.mark.parametrize("mirrored", [False, True])
def test_normals_are_turned_with_the_frames(angle: float, mirrored: bool) -> None:
    """The direction in space stays, whichever frame says it."""
    used = {"normal": TextureMap(0)}
    asked = model(Material(maps=used), Material(maps=used))
    points, frames = ask(asked)
    tangents = np.cos(angle) * frames.tangents + np.sin(angle) * frames.bitangents
    across = np.cos(angle) * frames.bitangents - np.sin(angle) * frames.tangents
    turned = TangentFrames(tangents, -across if mirrored else across)
    seen = []
    for each in (frames, turned):
        x, y, z = (2 * baked_maps(asked, points, each)["normal"] - 1).T[..., None]
        seen.append(x * each.tangents + y * each.bitangents + z * np.eye(3)[0])
    np.testing.assert_allclose(seen[0], seen[1], atol=1e-3)


def test_a_texture_that_does_not_decode_is_named() -> None:
    asked = model(Material(maps=EVERY), Material())
    broken = replace(asked.document.textures[0], name="broken.png", data=b"no image")
    asked = NispModel(replace(asked.document, textures=(broken,)))
    with pytest.raises(MeshError, match=r"texture broken\.png: expected an image"):
        baked_maps(asked, *ask(asked))
