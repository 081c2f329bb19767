"""OBJ text through xz at its highest level."""

from __future__ import annotations

import lzma

from benchmarks.assets.source import Source
from benchmarks.codecs import Setting, obj
from benchmarks.codecs.obj import settings
from nispcodec.core.asset import TexturedMesh

__all__ = ["decode", "encode", "settings"]

LEVEL = 9 | lzma.PRESET_EXTREME


def encode(source: Source, setting: Setting) -> bytes:
    """The text, packed."""
    return lzma.compress(obj.encode(source, setting), preset=LEVEL)


def decode(data: bytes, source: Source) -> TexturedMesh:
    """Unpacked and read."""
    return obj.decode(lzma.decompress(data), source)
