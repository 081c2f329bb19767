"""Simplify with vertices that move, then Draco, over the same grid as `simplified_draco`."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from itertools import product

from benchmarks.assets.corners import Corners, corners_of
from benchmarks.assets.simplify_update import missing, simplified_moving
from benchmarks.assets.source import Source
from benchmarks.codecs import Setting, Unavailable, simplified_draco
from benchmarks.codecs.draco import decode, encode_corners

__all__ = ["decode", "encode", "settings"]

UV_WEIGHTS: Sequence[float] = (1.0, 10.0, 100.0)
PERMISSIVE = "permissive"
SEAMS = ("protected", PERMISSIVE)
"""Whether edges between charts stay, or may go like any other edge."""


def settings(source: Source, quick: bool) -> list[Setting]:
    """Weights of UVs and what becomes of seams, each with the grid of `simplified_draco`.

    Raises Unavailable without node or the package.
    """
    reason = missing()
    if reason is not None:
        raise Unavailable(reason)
    return moving(simplified_draco.settings(source, quick))


def moving(grid: Iterable[Setting]) -> list[Setting]:
    """Every weight and way with seams for the settings of a grid but those that keep all faces."""
    fewer = [each for each in grid if each["kept"] != 1.0]
    ways = product(UV_WEIGHTS, SEAMS, fewer)
    return [{**each, "uv_weight": weight, "seams": seams} for weight, seams, each in ways]


def encode(source: Source, setting: Setting) -> bytes:
    """`kept` is of all faces of the asset, whether hidden ones were dropped first or not."""
    return encode_corners(simplified(source, setting), setting)


def simplified(source: Source, setting: Setting) -> Corners:
    """The mesh of a setting before its coordinates are rounded. Raises ValueError when none is."""
    where = str(setting["surface"]), float(setting["kept"])
    return _simplified(source, *where, float(setting["uv_weight"]), str(setting["seams"]))


@lru_cache(maxsize=1)
def _simplified(source: Source, surface: str, kept: float, uv_weight: float, seams: str) -> Corners:
    """Settings that differ in bits alone come one after the other."""
    corners = corners_of(source.mesh, source.outer_faces if surface == "outer" else None)
    faces = round(kept * len(source.mesh.faces))
    return simplified_moving(corners, faces, uv_weight, seams == PERMISSIVE)
