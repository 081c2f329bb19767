"""Whole assets in so many bytes: within the total, and shared so that pictures lose least."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from nispcodec.core.asset import Material, TexturedMesh, TextureMap
from nispcodec.core.document import Document
from nispcodec.core.errors import NispError
from nispcodec.core.progress import Listener, Progress, silent
from nispcodec.encode.config import EncodeConfig, TotalConfig
from nispcodec.encode.recipe import encode
from nispcodec.encode.total import encode_to_total
from nispcodec.format import pack
from nispcodec.model import NispModel
from tests.encode.test_compact_images import noisy
from tests.geometry.shapes import box_asset

SMALL = TotalConfig(views=2, size=48, qualities=(1, 50, 100), least_geometry=100)
NEVER, ALWAYS = replace(SMALL, worth_a_fit=0.0), replace(SMALL, worth_a_fit=1e9)


def asset() -> TexturedMesh:
    """A box with a color and a normal map, 4,000 bytes at most qualities."""
    maps = {"base_color": TextureMap(0), "normal": TextureMap(1)}
    mesh = box_asset()
    materials = tuple(Material(f"m{n}", maps=maps) for n in range(len(mesh.materials)))
    return replace(mesh, materials=materials, textures=(noisy(0), noisy(1)))


@cache
def box() -> Document:
    return encode(asset(), EncodeConfig(geometry="mesh", textures=False)).document


class Geometry:
    """The triangles of a box, with ballast up to about the size that is asked for, or `usual`."""

    def __init__(self, usual: int) -> None:
        self.usual = usual
        self.asked: list[EncodeConfig] = []

    def __call__(self, config: EncodeConfig, listen: Listener) -> NispModel:
        self.asked.append(config)
        listen(Progress(stage="triangles", overall=1.0))
        size = max(0, int(config.target_size or self.usual) - len(pack(box())))
        signs = "".join(map(chr, np.random.default_rng(0).integers(0x21, 0x7E, size)))
        ballast = {f"{start}": signs[start : start + 900] for start in range(0, size, 900)}
        return NispModel(replace(box(), info=ballast))


def encoded(
    total: float, tuning: TotalConfig = NEVER, usual: int = 600, listen: Listener = silent
) -> tuple[Document, Geometry]:
    geometry = Geometry(usual)
    how = EncodeConfig(geometry="mesh", target_total=total)
    return encode_to_total(asset(), how, tuning, geometry, listen).document, geometry


@pytest.mark.parametrize("total", [4_000, 6_000])
def test_a_file_takes_the_total_and_hardly_less(total: int) -> None:
    document, geometry = encoded(total)
    assert 0.93 * total <= len(pack(document)) <= total
    assert document.materials == asset().materials
    assert len(geometry.asked) == 1


def test_geometry_that_leaves_images_no_room_is_made_smaller() -> None:
    document, geometry = encoded(2_500, usual=2_450)
    assert len(pack(document)) <= 2_500
    assert [bool(each.target_size) for each in geometry.asked] == [False, True]


def test_another_share_is_tried_and_the_better_one_taken() -> None:
    one, _ = encoded(4_000, usual=1_000)
    best, geometry = encoded(4_000, ALWAYS, usual=1_000)
    assert len(geometry.asked) == 2
    assert len(pack(best)) <= 4_000
    # The ballast is worth nothing: with less of it images are better.
    assert (geometry.asked[1].target_size or 0) < 1_000
    assert float(best.info["rendered_psnr"]) > float(one.info["rendered_psnr"])


def test_a_share_that_geometry_cannot_have_changes_nothing() -> None:
    class Stubborn(Geometry):
        def __call__(self, config: EncodeConfig, listen: Listener) -> NispModel:
            if config.target_size:
                raise NispError("target size: expected more")
            return super().__call__(config, listen)

    how = EncodeConfig(target_total=4_000)
    found = encode_to_total(asset(), how, ALWAYS, Stubborn(600), silent).document
    assert found == encoded(4_000)[0]


def test_images_that_have_room_stay_as_they_came() -> None:
    document, _ = encoded(1e7)
    assert document.textures == asset().textures


def test_a_total_below_the_smallest_images_is_refused_before_the_work() -> None:
    geometry = Geometry(600)
    how = EncodeConfig(target_total=500)
    with pytest.raises(
        NispError, match=r"target total: expected at least [\d,]+ bytes, .* found 500"
    ):
        encode_to_total(asset(), how, SMALL, geometry, silent)
    assert geometry.asked == []


def test_without_images_the_total_is_for_geometry() -> None:
    geometry = Geometry(600)
    bare = box_asset()
    encode_to_total(bare, EncodeConfig(target_total=700), SMALL, geometry, silent)
    (asked,) = geometry.asked
    assert (asked.target_size, asked.target_total) == (700, None)


def test_progress_never_falls() -> None:
    told: list[float] = []
    encoded(4_000, ALWAYS, listen=lambda update: told.append(update.overall))
    assert told == sorted(told)
    assert told[0] == 0
