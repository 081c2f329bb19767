"""Images as other programs show them alike: of formats that they know, without profiles and turns.

A `.nisp`'s reader ignores what an image file says about how its texels are to be shown, as glTF has
it; many programs do not, so those parts stay away. The texels are the same.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Collection, Iterator
from dataclasses import replace

from nispcodec.core.asset import Texture
from nispcodec.core.texture import encode_image, image_bytes

MIMES = ("image/png", "image/jpeg", "image/webp")
"""Of the images that most programs know; USDZ and others that know fewer have their own."""

# Color, the shape of a pixel, and EXIF, which turns.
_PNG = (b"iCCP", b"gAMA", b"cHRM", b"sRGB", b"cICP", b"pHYs", b"eXIf")
_JPEG = {0xE1: b"Exif\0", 0xE2: b"ICC_PROFILE\0"}
_WEBP = {b"ICCP": 0x20, b"EXIF": 0x08}
"""Chunks, and the flags of VP8X that announce them."""


def plain_image(texture: Texture, mimes: Collection[str]) -> Texture:
    """The texture without profile and turn, as PNG where its type is none of `mimes`.

    What is malformed stays as it is. Raises MeshError for an image of another type that does not
    decode.
    """
    if texture.mime not in mimes:
        data = encode_image(image_bytes(texture), "png", quality=100)
        return replace(texture, data=data, mime="image/png")
    strip = _STRIPPED.get(texture.mime)
    return replace(texture, data=strip(texture.data)) if strip else texture


def _png(data: bytes) -> bytes:
    kept, at = [data[:8]], 8
    while at + 12 <= len(data):
        (length,) = struct.unpack_from(">I", data, at)
        if data[at + 4 : at + 8] not in _PNG:
            kept.append(data[at : at + 12 + length])
        at += 12 + length
    return b"".join([*kept, data[at:]])


def _jpeg(data: bytes) -> bytes:
    kept, at = [data[:2]], 2
    while data[at : at + 1] == b"\xff" and at + 4 <= len(data) and data[at + 1] != 0xDA:
        (length,) = struct.unpack_from(">H", data, at + 2)
        kind, end = data[at + 1], at + 2 + length
        if not data.startswith(_JPEG.get(kind, b"\xff"), at + 4):
            kept.append(data[at:end])
        at = end
    return b"".join([*kept, data[at:]])


def _webp(data: bytes) -> bytes:
    chunks = list(_riff(data))
    dropped = sum(_WEBP[name] for name in {name for name, _ in chunks} & set(_WEBP))
    if not dropped:
        return data
    kept = [
        chunk[:8] + bytes([chunk[8] & ~dropped]) + chunk[9:] if name == b"VP8X" else chunk
        for name, chunk in chunks
        if name not in _WEBP
    ]
    body = b"WEBP" + b"".join(kept)
    return b"RIFF" + struct.pack("<I", len(body)) + body


def _riff(data: bytes) -> Iterator[tuple[bytes, bytes]]:
    """The name and the bytes of each chunk, name and length with them."""
    at = 12
    while at + 8 < len(data):
        (length,) = struct.unpack_from("<I", data, at + 4)
        end = at + 8 + length + length % 2
        yield data[at : at + 4], data[at:end]
        at = end


_STRIPPED: dict[str, Callable[[bytes], bytes]] = {
    "image/png": _png,
    "image/jpeg": _jpeg,
    "image/webp": _webp,
}
