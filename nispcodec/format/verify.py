"""The problems of a file: everything that can be checked without the original asset."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from nispcodec.core.asset import Texture
from nispcodec.core.errors import FormatError, NispError
from nispcodec.format.constants import TXTR
from nispcodec.format.document import unpack

_STARTS = {
    "image/png": (0, b"\x89PNG\r\n\x1a\n"),
    "image/jpeg": (0, b"\xff\xd8\xff"),
    "image/webp": (8, b"WEBP"),
    "image/avif": (4, b"ftypavi"),
}


def verify(data: bytes, decode_texture: Callable[[Texture], object]) -> list[FormatError]:
    """The problems of a file, none if it is sound.

    Structure, checksums, caps, canonical form and finite weights are the parser's: its first error
    is the only problem then. `decode_texture` raises NispError for an image that does not decode;
    it is the caller's so that the format needs no image library. Raises nothing itself.
    """
    try:
        document = unpack(data)
    except FormatError as error:
        return [error]
    return [
        problem
        for number, texture in enumerate(document.textures)
        for problem in _texture_problems(f"textures.{number}", texture, decode_texture)
    ]


def _texture_problems(
    field: str, texture: Texture, decode_texture: Callable[[Texture], object]
) -> Iterator[FormatError]:
    offset, start = _STARTS[texture.mime]
    found = texture.data[offset : offset + len(start)]
    if found != start:
        expected = f"{texture.name} an image of {texture.mime}, beginning with {start!r}"
        yield FormatError(TXTR, field, expected, found)
    try:
        decode_texture(texture)
    except NispError as error:
        yield FormatError(TXTR, field, f"{texture.name} an image that decodes", error)
