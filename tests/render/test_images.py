from __future__ import annotations

import io

import numpy as np
import PIL.Image
import PIL.ImageSequence
import pytest

from nispcodec.render.difference import SCALE, difference, heat
from nispcodec.render.images import SUFFIXES, image_bytes

PICTURE = np.zeros((4, 6, 4), np.float32)
PICTURE[1, 2] = (1, 0.5, 0, 1)


def opened(data: bytes) -> PIL.Image.Image:
    return PIL.Image.open(io.BytesIO(data))


@pytest.mark.parametrize("suffix", [".png", ".webp"])
def test_pixels_come_back(suffix: str) -> None:
    back = np.asarray(opened(image_bytes([PICTURE], suffix)).convert("RGBA"))
    assert back.shape == (4, 6, 4)
    assert tuple(back[1, 2]) == (255, 128, 0, 255)
    assert back[0, 0, 3] == 0


@pytest.mark.parametrize("suffix", [".webp", ".gif"])
def test_many_pictures_become_one_animation(suffix: str) -> None:
    turn = [np.roll(PICTURE, i, axis=1) for i in range(5)]
    frames = PIL.ImageSequence.Iterator(opened(image_bytes(turn, suffix)))
    assert len(list(frames)) == 5


def test_a_gif_stands_on_white() -> None:
    back = np.asarray(opened(image_bytes([PICTURE], ".gif")).convert("RGB"))
    assert tuple(back[0, 0]) == (255, 255, 255)


def test_every_suffix_is_written() -> None:
    assert all(image_bytes([PICTURE], suffix) for suffix in SUFFIXES)


def test_heat_goes_from_white_to_black() -> None:
    ends, thirds = np.array([0, SCALE, 9], np.float32), np.array([SCALE / 3, 2 * SCALE / 3])
    np.testing.assert_array_equal(heat(ends), [[1] * 3, [0] * 3, [0] * 3])
    yellow, red = heat(thirds.astype(np.float32))
    np.testing.assert_allclose([yellow, red], [[1, 1, 0], [1, 0, 0]], atol=1e-6)


def test_difference_is_the_worst_channels() -> None:
    first, second = np.zeros((2, 1, 1, 3), np.float32)
    second[0, 0] = (0.1, 0.4, 0.2)
    assert difference(first, second)[0, 0] == np.float32(0.4)
