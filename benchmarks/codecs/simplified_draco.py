"""Simplify, then Draco, over a grid: its lower convex hull is the line to beat.

Where an asset has hidden faces, a second variant drops those that cannot be seen first.
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib.util import find_spec
from itertools import product

from benchmarks.assets.corners import corners_of
from benchmarks.assets.simplify import simplified
from benchmarks.assets.source import Source
from benchmarks.codecs import Setting, Unavailable
from benchmarks.codecs.draco import decode, encode_corners

__all__ = ["decode", "encode", "settings"]

KEPT: Sequence[float] = (
    1.0, 0.84, 0.7, 0.59, 0.5, 0.42, 0.35, 0.25, 0.18, 0.125, 0.09, 0.0625, 0.044, 0.031, 0.022,
)  # fmt: skip
QUICK: Sequence[float] = (0.5, 0.25, 0.125, 0.0625)
BITS = ((8, 8), (9, 9), (10, 9), (10, 10), (11, 10), (11, 11), (12, 11))
QUICK_BITS = ((10, 10),)
FEWEST = 150
# Below this share of the area, the variant without hidden faces would be the same mesh again.
NOTABLE = 0.005


def settings(source: Source, quick: bool) -> list[Setting]:
    """Shares of the faces to keep, bits of positions and UVs, all faces or the outer ones.

    Raises Unavailable without meshoptimizer.
    """
    if find_spec("meshoptimizer") is None:
        raise Unavailable("meshoptimizer is not installed: extra `simplify`")
    surfaces = ("all", "outer") if source.hidden_share > NOTABLE else ("all",)
    shares = [kept for kept in (QUICK if quick else KEPT) if kept * len(source.mesh.faces) > FEWEST]
    grid = product(surfaces, shares, QUICK_BITS if quick else BITS)
    return [{"surface": surface, "kept": kept, "qp": p, "qt": t} for surface, kept, (p, t) in grid]


def encode(source: Source, setting: Setting) -> bytes:
    """`kept` is of all faces of the asset, whether hidden ones were dropped first or not."""
    chosen = source.outer_faces if setting["surface"] == "outer" else None
    corners = corners_of(source.mesh, chosen)
    faces = round(float(setting["kept"]) * len(source.mesh.faces))
    return encode_corners(simplified(corners, faces), setting)
