"""Image files: recognized and checked, never changed unless no viewer could read them."""

from __future__ import annotations

import io
import re
import struct
import warnings
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import PurePath

import numpy as np
import PIL.Image

from nispcodec.core.asset import Texture
from nispcodec.core.errors import MeshError

# The formats that stay as they are, by Pillow's name.
_KEPT = {
    "PNG": ("image/png", ".png"),
    "JPEG": ("image/jpeg", ".jpg"),
    "MPO": ("image/jpeg", ".jpg"),
    "WEBP": ("image/webp", ".webp"),
    "AVIF": ("image/avif", ".avif"),
}
_CONVERTED = (
    "PSD",
    "TGA",
    "BMP",
    "DIB",
    "TIFF",
    "GIF",
    "DDS",
    "JPEG2000",
    "PPM",
    "PCX",
    "SGI",
    "ICO",
)
# First bytes of formats that assets come with and that no reader here knows.
_UNSUPPORTED = {b"v/1\x01": "an OpenEXR", b"#?RADIANCE": "a Radiance", b"\xabKTX": "a KTX"}
# What Pillow's readers raise for malformed files.
_BROKEN = (
    OSError,
    ValueError,
    SyntaxError,
    EOFError,
    ArithmeticError,
    LookupError,
    RuntimeError,
    TypeError,
    struct.error,
    zlib.error,
)


class TextureShelf:
    """The distinct textures of one asset, gathered while its materials are read."""

    def __init__(self, warnings: list[str]) -> None:
        self.textures: list[Texture] = []
        self._warnings = warnings
        self._places: dict[bytes, int] = {}

    def add(self, name: str, data: bytes, place: str) -> int | None:
        """The index of the texture with these bytes, which is added if it is new.

        `name` is the image's file name, `place` says in messages where it stands. None, with a
        warning, for a format that is known but not supported. Raises MeshError for bytes that are
        no image.
        """
        kind = _unsupported(data)
        if kind is not None:
            self._warnings.append(f"{place}: {kind} image is not supported: left out")
            return None
        if data not in self._places:
            texture = self._checked(name, data, place)
            self._places[data] = len(self.textures)
            self.textures.append(texture)
        return self._places[data]

    def _checked(self, name: str, data: bytes, place: str) -> Texture:
        image = _decoded(data, place)
        found = str(image.format)
        stem = _stem(name)
        if found in _KEPT:
            mime, suffix = _KEPT[found]
            return Texture(self._free_name(stem, suffix), data, mime)
        self._warnings.append(f"{place}: a {found} image, converted to PNG")
        return Texture(self._free_name(stem, ".png"), _as_png(image, place), "image/png")

    def _free_name(self, stem: str, suffix: str) -> str:
        taken = {texture.name.casefold() for texture in self.textures}
        names = (f"{stem}{'' if count == 1 else f'_{count}'}{suffix}" for count in range(1, 10**9))
        return next(name for name in names if name.casefold() not in taken)


def is_gray(data: bytes, place: str) -> bool:
    """Whether an image has no color anywhere, told from 64 x 64 of its texels.

    `place` names it in messages. Raises MeshError for bytes that are no image.
    """
    if _unsupported(data) is not None:
        return False
    small = _decoded(data, place).convert("RGB").resize((64, 64), PIL.Image.Resampling.NEAREST)
    return bool(np.ptp(np.asarray(small, dtype=np.int16), axis=2).max() <= 2)


def _unsupported(data: bytes) -> str | None:
    return next((kind for start, kind in _UNSUPPORTED.items() if data.startswith(start)), None)


def _decoded(data: bytes, place: str) -> PIL.Image.Image:
    """Decode every pixel, so that a damaged image is found now and not by the viewer."""
    PIL.Image.init()  # else only the few common formats are registered
    formats = [name for name in (*_KEPT, *_CONVERTED) if name in PIL.Image.OPEN]
    with _pillow(place):
        PIL.Image.open(io.BytesIO(data), formats=formats).verify()
        image = PIL.Image.open(io.BytesIO(data), formats=formats)
        image.load()
    return image


def _as_png(image: PIL.Image.Image, place: str) -> bytes:
    buffer = io.BytesIO()
    mode = image.mode if image.mode in ("1", "L", "LA", "RGB", "RGBA", "P", "I;16") else "RGBA"
    with _pillow(place):
        image.convert(mode).save(buffer, "PNG")
    return buffer.getvalue()


@contextmanager
def _pillow(place: str) -> Iterator[None]:
    """Turn what Pillow raises, and its warning of decompression bombs, into MeshError."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            # Pillow only warns of images below twice its limit.
            warnings.simplefilter("error", PIL.Image.DecompressionBombWarning)
            yield
    except (*_BROKEN, PIL.Image.DecompressionBombWarning, PIL.Image.DecompressionBombError) as why:
        reason = str(why).split("<_io")[0]
        raise MeshError(f"{place}: expected an image that can be decoded, found: {reason}") from why


def _stem(name: str) -> str:
    """A bare file name that every file system takes."""
    stem = PurePath(re.split(r"[\\/]", name)[-1]).stem
    return re.sub(r'[\x00-\x1f<>:"|?*]', "_", stem).strip(" .")[:100] or "texture"
