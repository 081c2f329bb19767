from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from nispcodec.core.asset import Material, TexturedMesh, TextureMap
from nispcodec.core.errors import MeshError
from tests import tiny

MESH = replace(
    TexturedMesh.geometry_only(np.eye(3), np.arange(3)[None], "m"),
    textures=(tiny.png(np.zeros((1, 1, 3), np.uint8)),),
)


@pytest.mark.parametrize(
    ("material", "said"),
    [
        (Material("a\tb"), "material 'a\\\\tb': expected a name without control characters"),
        (Material("\ud800"), "expected a name without control characters"),
        (Material("m", alpha_mode="fog"), "material 'm': alpha mode: expected one of opaque"),
        (Material("m", maps={"gloss": TextureMap(0)}), "slot: expected one of base_color"),
        (
            Material("m", maps={"normal": TextureMap(1)}),
            "normal: expected a texture below 1, found",
        ),
        (Material("m", maps={"normal": TextureMap(-1)}), "normal: expected a texture below 1"),
        (Material("m", maps={"normal": TextureMap(0, ("wrap", "clamp"))}), "wrap: expected one of"),
        (Material("m", maps={"normal": TextureMap(0, filter="cubic")}), "filter: expected one of"),
    ],
)
def test_materials_that_make_no_sense_are_refused(material: Any, said: str) -> None:
    with pytest.raises(MeshError, match=said):
        replace(MESH, materials=(material,))


def test_a_sound_material_is_taken() -> None:
    sound = Material(
        "m", alpha_mode="blend", maps={"occlusion": TextureMap(0, ("clamp", "mirror"))}
    )
    assert replace(MESH, materials=(sound,)).materials == (sound,)
