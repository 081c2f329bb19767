"""Image files: recognized and checked, never changed unless no viewer could read them."""

from __future__ import annotations

import io
import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import PurePath

import numpy as np
import PIL.Image

from nispcodec.core.arrays import Uint16Array
from nispcodec.core.asset import Texture
from nispcodec.core.counted import counted
from nispcodec.core.errors import MeshError, NispError
from nispcodec.core.texture import BROKEN_IMAGE, what_is_broken
from nispcodec.io.ktx2 import is_ktx2, png_of_ktx2

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
_UNSUPPORTED = {
    b"v/1\x01": "an OpenEXR",
    b"#?R": "a Radiance",
    b"\xabKTX 11": "a KTX 1",
    b"<svg": "an SVG",
}
# What may stand before the first element of XML.
_BEFORE_XML = re.compile(rb"^(\xef\xbb\xbf)?(\s+|<[?!][^>]*>)*")
_START_OF_JPEG, _END_OF_JPEG = b"\xff\xd8", b"\xff\xd9"
# Pillow's modes that PNG holds as they are; wide gray is narrowed, others become RGBA.
_PNG_MODES = ("1", "L", "LA", "RGB", "RGBA", "P", "I;16")
_BITS, _PHOTOMETRIC, _SAMPLE_FORMAT = 258, 262, 339  # of TIFF
_WHITE_IS_ZERO, _SIGNED = 0, 2
_ORIENTATION = 274  # of EXIF
# What undoes each orientation but the first, that of texels as they are stored.
_AS_STORED = {
    2: PIL.Image.Transpose.FLIP_LEFT_RIGHT,
    3: PIL.Image.Transpose.ROTATE_180,
    4: PIL.Image.Transpose.FLIP_TOP_BOTTOM,
    5: PIL.Image.Transpose.TRANSPOSE,
    6: PIL.Image.Transpose.ROTATE_90,
    7: PIL.Image.Transpose.TRANSVERSE,
    8: PIL.Image.Transpose.ROTATE_270,
}


class TextureShelf:
    """The distinct textures of one asset, gathered while its materials are read."""

    def __init__(self, warnings: list[str]) -> None:
        self.textures: list[Texture] = []
        self._warnings = warnings
        self._places: dict[bytes, int] = {}

    def add(self, name: str, data: bytes, place: str) -> int | None:
        """The index of the texture with these bytes, which is added if it is new.

        `name` is the image's file name, `place` says in messages where it stands. None, with a
        warning, for what is no image that can be read: the asset goes on without.
        """
        if data not in self._places:
            try:
                texture = self._texture(name, data, place)
            except NispError as why:
                self._warnings.append(f"{why}: left out")
                return None
            self._places[data] = self._placed(texture)
        return self._places[data]

    def _placed(self, texture: Texture) -> int:
        """The index of the texture with these bytes, which may have been here from the start."""
        for index, known in enumerate(self.textures):
            if known.data == texture.data:
                return index
        self.textures.append(texture)
        return len(self.textures) - 1

    def _texture(self, name: str, data: bytes, place: str) -> Texture:
        kind = _unsupported(data)
        if kind is not None:
            raise MeshError(f"{place}: {kind} image is not supported")
        if is_ktx2(data):
            return self._converted("KTX2", name, png_of_ktx2(data, place), place)
        data, image = self._whole(data, place)
        orientation = _orientation(data, image)
        self._warn_of_change(image, orientation, place)
        found = str(image.format)
        if image.mode == "CMYK":  # what it shows differs from program to program
            found = f"{found} in CMYK"
        if found in _KEPT:
            mime, suffix = _KEPT[found]
            return Texture(self._free_name(_stem(name), suffix), data, mime)
        turn = _AS_STORED.get(orientation) if found.startswith("TIFF") else None
        return self._converted(found, name, _as_png(image, place, turn), place)

    def _warn_of_change(self, image: PIL.Image.Image, orientation: int, place: str) -> None:
        if orientation in _AS_STORED:
            self._warnings.append(
                f"{place}: turned or mirrored by its EXIF orientation, which no mesh heeds: "
                f"taken as it is stored"
            )
        values = np.asarray(image) if image.mode == "F" else np.zeros(1)
        beyond = int((~((values >= 0) & (values <= 1))).sum())
        if beyond:
            self._warnings.append(
                f"{place}: expected numbers from 0 to 1, found {counted(beyond, 'texel')} "
                f"with others: cut to it"
            )

    def _converted(self, found: str, name: str, png: bytes, place: str) -> Texture:
        self._warnings.append(f"{place}: a {found} image, converted to PNG")
        return Texture(self._free_name(_stem(name), ".png"), png, "image/png")

    def _whole(self, data: bytes, place: str) -> tuple[bytes, PIL.Image.Image]:
        """The bytes and the image in them; a JPEG that is cut short gets its end mark."""
        try:
            return data, _decoded(data, place)
        except MeshError:
            ended = data + _END_OF_JPEG
            image = _decoded_or_none(ended) if data.startswith(_START_OF_JPEG) else None
            if image is None:
                raise
        self._warnings.append(f"{place}: cut short: what is missing of the image is gray")
        return ended, image

    def _free_name(self, stem: str, suffix: str) -> str:
        taken = {texture.name.casefold() for texture in self.textures}
        names = (f"{stem}{'' if count == 1 else f'_{count}'}{suffix}" for count in range(1, 10**9))
        return next(name for name in names if name.casefold() not in taken)


def is_gray(data: bytes) -> bool:
    """Whether an image has no color anywhere, told from 64 x 64 of its texels.

    False for what cannot be decoded.
    """
    image = _decoded_or_none(data)
    if image is None:
        return False
    small = image.convert("RGB").resize((64, 64), PIL.Image.Resampling.NEAREST)
    return bool(np.ptp(np.asarray(small, dtype=np.int16), axis=2).max() <= 2)


def _unsupported(data: bytes) -> str | None:
    head = _BEFORE_XML.sub(b"", data[:2000])
    return next((kind for start, kind in _UNSUPPORTED.items() if head.startswith(start)), None)


def _decoded_or_none(data: bytes) -> PIL.Image.Image | None:
    try:
        return _decoded(data, "image")
    except MeshError:
        return None


def _decoded(data: bytes, place: str) -> PIL.Image.Image:
    """Decode every pixel, so that a damaged image is found now and not by the viewer."""
    PIL.Image.init()  # else only the few common formats are registered
    formats = [name for name in (*_KEPT, *_CONVERTED) if name in PIL.Image.OPEN]
    with _pillow(place):
        PIL.Image.open(io.BytesIO(data), formats=formats).verify()
        image = PIL.Image.open(io.BytesIO(data), formats=formats)
        image.load()
    return image


def _orientation(data: bytes, image: PIL.Image.Image) -> int:
    """That of the EXIF or XMP of an image, 1 where it has none that can be read.

    `data` are the bytes of the `image`, which has lost it where it is a TIFF.
    """
    try:
        with _pillow("image"):
            if image.format == "TIFF":
                image = PIL.Image.open(io.BytesIO(data), formats=["TIFF"])
            return int(image.getexif().get(_ORIENTATION, 1))
    except MeshError:
        return 1


def _as_png(image: PIL.Image.Image, place: str, turn: PIL.Image.Transpose | None = None) -> bytes:
    """The image as PNG, turned or mirrored: Pillow heeds the orientation of TIFF, meshes do not."""
    if image.mode == "LAB":  # Pillow would take its numbers for RGB
        raise MeshError(f"{place}: expected an image in RGB or gray, found one in L*a*b*")
    if image.mode in ("I", "F") or image.mode.startswith("I;16"):
        image = PIL.Image.fromarray(_gray_16(image))
    if turn is not None:
        image = image.transpose(turn)
    buffer = io.BytesIO()
    with _pillow(place):
        image.convert(image.mode if image.mode in _PNG_MODES else "RGBA").save(buffer, "PNG")
    return buffer.getvalue()


def _gray_16(image: PIL.Image.Image) -> Uint16Array:
    """Gray of a wide type in 16 bits: the whole range of integers, 0 to 1 of floats."""
    values, tags = np.asarray(image), getattr(image, "tag_v2", {})
    if image.mode == "F":
        shares = np.nan_to_num(values.astype(np.float64), nan=0.0)
    else:
        bits, signed = tags.get(_BITS, (16,))[0], tags.get(_SAMPLE_FORMAT, (1,))[0] == _SIGNED
        # Pillow keeps all integers as signed ones of 32 bits.
        integers = values if signed else values.astype(np.int64) % 2**32
        shares = integers / (2.0 ** (bits - signed) - 1)
    if tags.get(_PHOTOMETRIC) == _WHITE_IS_ZERO:  # which Pillow heeds in narrow types alone
        shares = 1.0 - shares
    return np.rint(np.clip(shares, 0.0, 1.0) * 65535).astype(np.uint16)


@contextmanager
def _pillow(place: str) -> Iterator[None]:
    """Turn what Pillow raises, and its warning of decompression bombs, into MeshError."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            # Pillow only warns of images below twice its limit.
            warnings.simplefilter("error", PIL.Image.DecompressionBombWarning)
            yield
    except (PIL.Image.DecompressionBombWarning, PIL.Image.DecompressionBombError) as why:
        found = re.search(r"\d+ pixels", str(why))
        raise MeshError(
            f"{place}: expected an image of at most {PIL.Image.MAX_IMAGE_PIXELS} pixels, found "
            f"{found[0] if found else 'more'} (8192 x 8192 can be read)"
        ) from why
    except BROKEN_IMAGE as why:
        broken = what_is_broken(why)
        raise MeshError(f"{place}: expected an image that can be decoded, found: {broken}") from why


def _stem(name: str) -> str:
    """A bare file name that every file system takes."""
    stem = PurePath(re.split(r"[\\/]", name)[-1]).stem
    plain = re.sub(r'[\x00-\x1f\x7f\ud800-\udfff<>:"|?*]', "_", stem)
    return plain.encode()[:100].decode(errors="ignore").strip(" .") or "texture"
