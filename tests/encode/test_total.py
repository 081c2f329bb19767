"""Whole assets in so many bytes: within the total, and shared so that pictures lose least."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from nispcodec.core.asset import Material, TexturedMesh, TextureMap
from nispcodec.core.document import Document
from nispcodec.core.errors import NispError, TargetSizeError
from nispcodec.core.progress import Listener, Progress, silent
from nispcodec.core.texture import image_size
from nispcodec.encode.choice import Loss
from nispcodec.encode.config import EncodeConfig
from nispcodec.encode.recipe import encode
from nispcodec.encode.total import encode_to_total
from nispcodec.encode.total_config import TotalConfig
from nispcodec.format import pack
from nispcodec.model import NispModel
from tests import tiny
from tests.encode.test_compact_images import SIDE, noisy
from tests.geometry.shapes import box_asset

SMALL = TotalConfig(views=2, size=48, qualities=(1, 50, 100), scarce=0.0)
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


@cache
def octahedron() -> Document:
    """Networks, with the charts of a box's place."""
    document = tiny.document(frame=box().frame)
    return replace(document, materials=box().materials, textures=())


class Geometry:
    """Triangles of a box, or networks, and ballast up to the size that is asked for, or `usual`.

    Sizes below what it has without ballast are refused.
    """

    def __init__(self, usual: int, made: Callable[[], Document] = box) -> None:
        self.usual, self.made = usual, made
        self.asked: list[EncodeConfig] = []

    def __call__(
        self, config: EncodeConfig, listen: Listener, loss: Loss | None = None
    ) -> NispModel:
        self.asked.append(config)
        listen(Progress(stage="triangles", overall=1.0))
        least = len(pack(self.made()))
        if config.target_size and config.target_size < least:
            raise TargetSizeError(least, config.target_size)
        size = max(0, int(config.target_size or self.usual) - least)
        signs = "".join(map(chr, np.random.default_rng(0).integers(0x21, 0x7E, size)))
        ballast = {f"{start}": signs[start : start + 900] for start in range(0, size, 900)}
        return NispModel(replace(self.made(), info=ballast))


def encoded(
    total: float,
    tuning: TotalConfig = NEVER,
    usual: int = 600,
    listen: Listener = silent,
    made: Callable[[], Document] = box,
) -> tuple[Document, Geometry]:
    geometry = Geometry(usual, made)
    how = EncodeConfig(geometry="mesh", target_total=total)
    return encode_to_total(asset(), how, tuning, geometry, listen).document, geometry


@pytest.mark.parametrize("total", [4_000, 6_000])
def test_a_file_takes_the_total_and_hardly_less(total: int) -> None:
    document, geometry = encoded(total)
    assert 0.93 * total <= len(pack(document)) <= total
    assert document.materials == asset().materials
    assert [image_size(each) for each in document.textures] == [(SIDE, SIDE)] * 2
    assert len(geometry.asked) == 1


def test_geometry_that_leaves_images_no_room_is_made_smaller() -> None:
    document, geometry = encoded(2_500, usual=3_000)
    assert len(pack(document)) <= 2_500
    assert [bool(each.target_size) for each in geometry.asked] == [False, True]


def test_networks_of_another_size_are_tried_and_the_better_ones_taken() -> None:
    twice = replace(ALWAYS, octaves=(1,))
    one, _ = encoded(5_000, usual=1_700, made=octahedron)
    best, geometry = encoded(5_000, twice, usual=1_700, made=octahedron)
    assert [each.geometry for each in geometry.asked] == ["mesh", "field"]
    assert (geometry.asked[1].target_size or 0) > 1_700
    assert len(pack(best)) <= 5_000
    assert float(best.info["rendered_psnr"]) >= float(one.info["rendered_psnr"])


def test_a_share_that_geometry_cannot_have_changes_nothing() -> None:
    class Stubborn(Geometry):
        def __call__(
            self, config: EncodeConfig, listen: Listener, loss: Loss | None = None
        ) -> NispModel:
            if config.target_size:
                raise NispError("target size: expected more")
            return super().__call__(config, listen, loss)

    how = EncodeConfig(target_total=5_000)
    stubborn = Stubborn(1_700, octahedron)
    found = encode_to_total(asset(), how, replace(ALWAYS, octaves=(1,)), stubborn, silent).document
    assert found == encoded(5_000, usual=1_700, made=octahedron)[0]


def test_images_that_have_room_stay_as_they_came() -> None:
    document, _ = encoded(1e7)
    assert document.textures == asset().textures


def refused(total: float, tuning: TotalConfig) -> tuple[int, Geometry]:
    """The least total that a refusal names, and what was asked before."""
    geometry = Geometry(10_000)
    how = EncodeConfig(geometry="mesh", target_total=total)
    with pytest.raises(NispError, match=rf"found {total:,.0f}$") as said:
        encode_to_total(asset(), how, tuning, geometry, silent)
    least = re.match(r"target total: expected at least ([\d,]+) bytes", str(said.value))
    assert least
    return int(least[1].replace(",", "")), geometry


def test_a_total_that_is_too_small_is_told_the_least_and_that_can_be_had() -> None:
    scarce = replace(NEVER, scarce=5_000)
    least, geometry = refused(500, scarce)
    assert [each.target_size for each in geometry.asked] == [1]
    for tuning in (scarce, NEVER):
        assert refused(least - 1, tuning)[0] == least
        assert len(pack(encoded(least, tuning, usual=10_000)[0])) <= least


def test_without_images_the_total_is_for_geometry() -> None:
    geometry = Geometry(600)
    bare = box_asset()
    encode_to_total(bare, EncodeConfig(target_total=700), SMALL, geometry, silent)
    (asked,) = geometry.asked
    assert (asked.target_size, asked.target_total) == (700, None)


def test_geometry_that_loses_less_in_pictures_and_leaves_images_more_is_told_apart() -> None:
    losses: list[float] = []

    class Asked(Geometry):
        def __call__(
            self, config: EncodeConfig, listen: Listener, loss: Loss | None = None
        ) -> NispModel:
            assert loss
            large = Geometry(1_500)(config, listen).document
            huge = Geometry(5_000)(config, listen).document
            losses.extend(map(loss, (box(), large, octahedron(), huge)))
            return super().__call__(config, listen)

    how = EncodeConfig(geometry="mesh", target_total=4_000)
    encode_to_total(asset(), how, NEVER, Asked(600), silent)
    small, large, other, none_left = losses
    assert small < large < other < none_left == np.inf


def test_progress_never_falls() -> None:
    told: list[float] = []
    encoded(4_000, ALWAYS, listen=lambda update: told.append(update.overall))
    assert told == sorted(told)
    assert told[0] == 0
