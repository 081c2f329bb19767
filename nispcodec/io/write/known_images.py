"""Images of formats that readers of an output do not know, as PNG."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from io import BytesIO

from nispcodec.core.asset import Texture


def known(texture: Texture, mimes: Collection[str]) -> Texture:
    """The texture, as PNG where its type is none of `mimes`."""
    if texture.mime in mimes:
        return texture
    from PIL import Image

    converted = BytesIO()
    with Image.open(BytesIO(texture.data)) as image:
        image.save(converted, "PNG")
    return replace(texture, data=converted.getvalue(), mime="image/png")
