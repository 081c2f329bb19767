"""Simplify with vertices that move, then meshoptimizer's codec and Zstandard."""

from __future__ import annotations

from benchmarks.assets.corners import mesh_of
from benchmarks.assets.source import Source
from benchmarks.codecs import Setting, meshopt
from benchmarks.codecs.simplified_update_draco import settings, simplified
from nispcodec.core.asset import TexturedMesh

__all__ = ["decode", "encode", "settings"]


def encode(source: Source, setting: Setting) -> bytes:
    """Settings are those of `simplified_update_draco`."""
    return meshopt.encode_corners(simplified(source, setting), setting)


def decode(data: bytes, source: Source) -> TexturedMesh:
    """The mesh in the bytes."""
    return mesh_of(source, meshopt.decode_corners(data))
