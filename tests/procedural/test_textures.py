from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.arrays import Uint8Array
from nispcodec.core.texture import image_bytes
from nispcodec.procedural.textures import COBALT, CREAM, SIZE, glaze_texture, wood_textures

CENTERS = (np.arange(SIZE) + 0.5) / SIZE


def rows(low: float, high: float) -> slice:
    """The rows whose v lies between; the first row is on top."""
    return slice(round((1 - high) * SIZE), round((1 - low) * SIZE))


@pytest.fixture(scope="module")
def glaze() -> Uint8Array:
    return image_bytes(glaze_texture())


def test_the_painted_wall_closes_at_its_seam(glaze: Uint8Array) -> None:
    """Whole waves and dots go around, the wall from u 0.02 to 0.98; the speckle is faint."""
    image = glaze[rows(0.52, 0.96)].astype(float)
    left, right = (image[:, np.abs(CENTERS - u).argmin(), :3] for u in (0.02, 0.98))
    assert np.abs(left - right).mean() < 6
    assert np.ptp(left, axis=0).max() > 100


def test_the_handle_is_blue_and_the_rim_is_cream(glaze: Uint8Array) -> None:
    image = glaze[..., :3] / 255
    np.testing.assert_allclose(image[rows(0.01, 0.16), 20:300].mean(axis=(0, 1)), COBALT, atol=0.01)
    np.testing.assert_allclose(image[rows(0.93, 0.97)].mean(axis=(0, 1)), CREAM, atol=0.03)


def test_dark_rings_of_the_wood_stand_out_in_its_normals() -> None:
    """Normals lean to where the height falls: x to the right, y upwards."""
    color, normals = (image_bytes(each)[..., :3].astype(float) for each in wood_textures())
    down, right = np.gradient(-color.sum(axis=2))
    for slope, axis in ((right, 0), (-down, 1)):
        leaning = normals[..., axis] / normals[..., 2] - normals[..., axis].mean() / 255
        assert np.corrcoef(-slope.ravel(), leaning.ravel())[0, 1] > 0.9
