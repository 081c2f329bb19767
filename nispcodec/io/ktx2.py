"""Images in KTX2 with Basis Universal, as glTF has them by KHR_texture_basisu."""

from __future__ import annotations

import io
import struct

import PIL.Image

from nispcodec.core.arrays import AnyArray
from nispcodec.core.errors import MeshError
from nispcodec.core.extras import require
from nispcodec.io.apart import ApartConfig, decode_apart

_SIGNATURE = b"\xabKTX 20\xbb\r\n\x1a\n"
_SIZE_AT = 20  # pixelWidth and pixelHeight, after the signature, vkFormat and typeSize


def is_ktx2(data: bytes) -> bool:
    """Whether the bytes begin as a KTX2 file does."""
    return data.startswith(_SIGNATURE)


def png_of_ktx2(data: bytes, place: str) -> bytes:
    """The largest level of a KTX2 image as PNG, in the order of its rows; alpha where it has some.

    Raises MeshError, naming `place`, for other content than Basis Universal and for more pixels
    than Pillow's limit; NispError without the extra `gltf`.
    """
    require("opengl_basisu", extra="gltf", what_for=f"{place}: reading KTX2")
    pixels = _pixel_count(data, place)
    # The pixels are there several times while they are handed over; transcoders do 20 million of
    # them a second and more.
    config = ApartConfig(seconds=1.5 + pixels / 5e6, memory=500_000_000 + 30 * pixels)
    (answer,) = decode_apart("nispcodec.io.ktx2:decode_ktx2", [data], config)
    if isinstance(answer, str):
        raise MeshError(f"{place}: expected a KTX2 image of Basis Universal, found: {answer}")
    file = io.BytesIO()
    PIL.Image.fromarray(answer["pixels"]).save(file, "PNG")
    return file.getvalue()


def _pixel_count(data: bytes, place: str) -> int:
    if len(data) < _SIZE_AT + 8:
        raise MeshError(f"{place}: expected the header of a KTX2 image, found {len(data)} bytes")
    width, height = struct.unpack_from("<II", data, _SIZE_AT)
    most = PIL.Image.MAX_IMAGE_PIXELS or 0
    if width * height > most:
        raise MeshError(
            f"{place}: expected an image of at most {most} pixels, found {width} x {height}"
        )
    return width * height


def decode_ktx2(data: bytes) -> dict[str, AnyArray]:
    """`pixels` (h, w, 3 or 4) uint8 of the largest level; for `decode_apart` alone.

    Raises what opengl_basisu raises for other data.
    """
    import opengl_basisu

    texture = opengl_basisu.open(data)
    pixels = texture.transcode("rgba8").data
    opaque = bool((pixels[..., 3] == 255).all())
    return {"pixels": pixels[..., :3] if opaque else pixels}
