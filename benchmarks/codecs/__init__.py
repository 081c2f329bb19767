"""The codecs that are compared: one small file each, with the same three functions.

settings(source, quick)   what to run on this asset; raises Unavailable with the reason if nothing
encode(source, setting)   the bytes that would be shipped, without textures
decode(data, source)      the mesh in those bytes; materials and textures are the source's
"""

from __future__ import annotations

from importlib import import_module
from typing import Protocol, cast

from benchmarks.assets.source import Source
from nispcodec.core.asset import TexturedMesh

Setting = dict[str, str | int | float]

CODECS = {
    "obj": "OBJ text",
    "obj_xz": "OBJ, xz",
    "obj_zst": "OBJ, zstd",
    "glb": "binary glTF",
    "gltfpack": "gltfpack",
    "draco": "Draco",
    "simplified_draco": "simplify + Draco",
    "simplified_update_draco": "simplify with moving vertices + Draco",
    "simplified_update_meshopt": "simplify with moving vertices + meshopt + zstd",
    "simplified_gltfpack": "gltfpack with its simplifier",
    "nisp": ".nisp",
    "nisp_paper": ".nisp, the paper's networks",
}
# Only when asked for: twenty minutes an asset and an hour pruned, and what
# `benchmarks.rate_distortion.rivals` tries, over a coarser grid.
OPTIONAL = {
    "nisp_paper", "simplified_update_draco", "simplified_update_meshopt", "simplified_gltfpack",
}  # fmt: skip
# Two points of these at once would stand in each other's way.
EVERY_CORE = {"nisp", "nisp_paper"}


class Unavailable(Exception):
    """The codec cannot run here, for the reason given."""


class Codec(Protocol):
    """What a module of this package offers."""

    def settings(self, source: Source, quick: bool) -> list[Setting]: ...

    def encode(self, source: Source, setting: Setting) -> bytes: ...

    def decode(self, data: bytes, source: Source) -> TexturedMesh: ...


def codec(name: str) -> Codec:
    """The codec of one of the names in CODECS."""
    return cast(Codec, import_module(f"benchmarks.codecs.{name}"))
