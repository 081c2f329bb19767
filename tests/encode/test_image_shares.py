"""Bytes shared between colors and data: all that fit, where pictures lose least."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.asset import Texture
from nispcodec.core.texture import image_bytes
from nispcodec.encode.compact_images import compact_images
from nispcodec.encode.image_shares import ErrorOf, ImageShares
from tests.encode.test_compact_images import asset

QUALITIES = (1, 50, 100)


def weighted(color: float, data: float) -> ErrorOf:
    """Squared errors of the two images of `asset`, weighted."""
    original = [image_bytes(each).astype(float) for each in asset().textures]

    def error_of(textures: tuple[Texture, ...]) -> float:
        pairs = zip(original, map(image_bytes, textures), strict=True)
        each = [float(np.square(before - after).mean()) for before, after in pairs]
        return color * each[0] + data * each[1]

    return error_of


def shares(error_of: ErrorOf | None = None) -> ImageShares:
    found = ImageShares(compact_images(asset()))
    found.measure(QUALITIES, found.original, error_of or weighted(1, 1))
    return found


def sizes(textures: tuple[Texture, ...]) -> list[int]:
    return [len(each.data) for each in textures]


@pytest.mark.parametrize("share", [0.0, 0.2, 0.5, 0.9])
def test_images_take_what_they_may_and_hardly_less(share: float) -> None:
    found = shares()
    highest = sum(len(each.at(100).data) for each in compact_images(asset()))
    most = found.least + share * (highest - found.least)
    total = sum(sizes(found.fitted(most)))
    assert 0.95 * most <= total <= most


def test_what_pictures_lose_more_by_gets_more_bytes() -> None:
    most = 0.3 * shares().original
    color = sizes(shares(weighted(100, 1)).fitted(most))
    data = sizes(shares(weighted(1, 100)).fitted(most))
    assert color[0] > 1.2 * data[0]
    assert data[1] > 1.2 * color[1]


def test_images_that_fit_stay_as_they_came() -> None:
    found = shares()
    assert found.fitted(found.original) == asset().textures


def test_more_bytes_lose_less_and_too_few_are_no_choice() -> None:
    found = shares()
    few, more = found.least * 1.5, found.least * 3
    assert found.error(few) > found.error(more) > found.error(found.original)
    assert found.error(found.least - 1) == np.inf
