from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from nispcodec.core.asset import Material
from nispcodec.core.progress import Progress, silent
from nispcodec.core.texture import image_bytes
from nispcodec.edit.texture_padding import with_padded_textures
from nispcodec.encode.appearance import appearance
from nispcodec.encode.config import EncodeConfig
from nispcodec.encode.total_config import CompactConfig
from tests.edit.test_texture_padding import GRAY, atlas


def test_nothing_is_touched_that_nobody_asked_for() -> None:
    mesh = atlas()
    told: list[Progress] = []
    materials, textures = appearance(mesh, EncodeConfig(), CompactConfig(), told.append)
    assert materials is mesh.materials
    assert textures is mesh.textures
    assert [each.stage for each in told] == ["textures"]


def test_without_textures_factors_remain() -> None:
    glass = Material("glass", (0.5, 0.5, 1.0, 0.25), roughness=0.1, maps=atlas().materials[0].maps)
    mesh = dataclasses.replace(atlas(), materials=(glass,))
    config = EncodeConfig(textures=False, pad_textures=True, texture_format="webp")
    materials, textures = appearance(mesh, config, CompactConfig(), silent)
    assert materials == (dataclasses.replace(glass, maps={}),)
    assert textures == ()


def test_padded_images_are_those_of_the_edit_at_the_quality_asked_for() -> None:
    mesh = atlas()
    jpeg = tuple(dataclasses.replace(each, mime="image/jpeg") for each in mesh.textures)
    mesh = dataclasses.replace(mesh, textures=jpeg)
    _, textures = appearance(
        mesh, EncodeConfig(pad_textures=True, texture_quality=20), CompactConfig(), silent
    )
    assert textures == with_padded_textures(mesh, 20) != with_padded_textures(mesh, 100)


@pytest.mark.parametrize("kind", ["webp", "jpeg"])
def test_images_are_padded_before_they_are_encoded_again(kind: str) -> None:
    mesh = atlas()
    config = EncodeConfig(pad_textures=True, texture_format=kind, texture_quality=100)
    materials, textures = appearance(mesh, config, CompactConfig(), silent)
    assert materials is mesh.materials
    assert [each.mime for each in textures] == [f"image/{kind}"] * len(mesh.textures)
    # Neither format keeps every color: what was gray is far from gray, and only in the used image.
    gray = np.array(GRAY, float)
    used, unused = (np.abs(image_bytes(each) - gray).max(axis=2) for each in textures)
    assert used.min() > 60
    assert unused.min() < 10
