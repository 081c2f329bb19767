"""OBJ text through Zstandard at its highest level."""

from __future__ import annotations

import zstandard

from benchmarks.assets.source import Source
from benchmarks.codecs import Setting, obj
from benchmarks.codecs.obj import settings
from nispcodec.core.asset import TexturedMesh

__all__ = ["decode", "encode", "settings"]

LEVEL = 22


def encode(source: Source, setting: Setting) -> bytes:
    """The text, packed."""
    return zstandard.ZstdCompressor(level=LEVEL).compress(obj.encode(source, setting))


def decode(data: bytes, source: Source) -> TexturedMesh:
    """Unpacked and read."""
    return obj.decode(zstandard.ZstdDecompressor().decompress(data), source)
