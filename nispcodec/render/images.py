"""Pictures as image files: PNG, WebP, GIF; one or a turn of many."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from typing import TYPE_CHECKING

import numpy as np

from nispcodec.core.arrays import Float32Array

if TYPE_CHECKING:
    import PIL.Image

EXACT = (".png", ".webp")
"""Keep every color; a GIF has 256."""
SUFFIXES = (*EXACT, ".gif")
TURN_SECONDS = 4.0


def image_bytes(pictures: Sequence[Float32Array], suffix: str) -> bytes:
    """The bytes of an image file of the format `suffix`, one of SUFFIXES.

    Pictures are (h, w, 3) or (h, w, 4) float in [0, 1], sRGB-encoded, alpha straight; several make
    an animation that lasts TURN_SECONDS and repeats. GIF knows no half transparency: its pictures
    stand on white.
    """
    frames = [_image(picture, opaque=suffix == ".gif") for picture in pictures]
    lossless = {"lossless": True} if suffix == ".webp" else {}
    turning = {
        "save_all": True,
        "append_images": frames[1:],
        "duration": round(1000 * TURN_SECONDS / len(frames)),
        "loop": 0,
    }
    file = BytesIO()
    frames[0].save(file, suffix[1:], **lossless, **(turning if len(frames) > 1 else {}))
    return file.getvalue()


def _image(picture: Float32Array, opaque: bool) -> PIL.Image.Image:
    from PIL import Image

    if opaque and picture.shape[2] == 4:
        picture = picture[..., :3] * picture[..., 3:] + (1 - picture[..., 3:])
    return Image.fromarray((np.clip(picture, 0, 1) * 255 + 0.5).astype(np.uint8))
