"""gltfpack with its own simplifier, which moves vertices, and `-cz`."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

from benchmarks.assets.source import Source
from benchmarks.codecs import Setting, gltfpack
from benchmarks.codecs.gltfpack import decode
from benchmarks.codecs.simplified_update_draco import PERMISSIVE, SEAMS

__all__ = ["decode", "encode", "settings"]

KEPT: Sequence[float] = (0.7, 0.5, 0.25, 0.125)
BITS = ((12, 12), (10, 10))
# As few triangles as asked for, however large the error; vertices and UVs move.
SIMPLIFY = ("-se", "1", "-sv")


def settings(source: Source, quick: bool) -> list[Setting]:
    """Shares of the faces, bits, and what becomes of seams. Raises Unavailable without gltfpack."""
    gltfpack.program()
    grid = product(SEAMS, KEPT[1:3] if quick else KEPT, BITS[:1] if quick else BITS)
    return [
        {"compression": "cz", "vp": vp, "vt": vt, "kept": kept, "seams": seams}
        for seams, kept, (vp, vt) in grid
    ]


def encode(source: Source, setting: Setting) -> bytes:
    """A GLB with KHR_meshopt_compression."""
    more = ["-sp"] if setting["seams"] == PERMISSIVE else []
    return gltfpack.packed(source, setting, "-si", str(setting["kept"]), *SIMPLIFY, *more)
