"""Simplify with vertices that move, then Draco, over the same grid as `simplified_draco`."""

from __future__ import annotations

from collections.abc import Sequence

from benchmarks.assets.corners import corners_of
from benchmarks.assets.simplify_update import missing, simplified_moving
from benchmarks.assets.source import Source
from benchmarks.codecs import Setting, Unavailable, simplified_draco
from benchmarks.codecs.draco import decode, encode_corners

__all__ = ["decode", "encode", "settings"]

UV_WEIGHTS: Sequence[float] = (1.0, 10.0, 100.0)


def settings(source: Source, quick: bool) -> list[Setting]:
    """Weights of UVs, each with the settings of `simplified_draco` but all faces.

    Raises Unavailable without node or the package.
    """
    reason = missing()
    if reason is not None:
        raise Unavailable(reason)
    others = [each for each in simplified_draco.settings(source, quick) if each["kept"] != 1.0]
    return [{**each, "uv_weight": weight} for weight in UV_WEIGHTS for each in others]


def encode(source: Source, setting: Setting) -> bytes:
    """`kept` is of all faces of the asset, whether hidden ones were dropped first or not."""
    chosen = source.outer_faces if setting["surface"] == "outer" else None
    corners = corners_of(source.mesh, chosen)
    faces = round(float(setting["kept"]) * len(source.mesh.faces))
    return encode_corners(simplified_moving(corners, faces, float(setting["uv_weight"])), setting)
