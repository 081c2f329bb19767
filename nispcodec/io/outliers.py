"""Few faces that take the resolution, or the accuracy of the UVs, from all others: warned of."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.core.asset import TexturedMesh

# Faces that say what is common.
MOST = 10_000


@dataclass(frozen=True)
class Limits:
    """When a few take accuracy from all others.

    few    the share of the area that counts as few
    far    how many times as large the whole may be for their sake
    least  an extent of the others below this counts as this
    """

    few: float
    far: float
    least: float


POSITIONS = Limits(few=1e-3, far=4.0, least=0.0)
# One face of a coarse mesh is more than a thousandth; a tile is nothing to lose.
UVS = Limits(few=1e-2, far=8.0, least=1.0)


def with_outliers_named(mesh: TexturedMesh) -> TexturedMesh:
    """The mesh with a warning for faces far from the others, and one for UVs far from the others.

    Networks spend their accuracy on the whole extent, so a speck far away costs everything else.
    """
    warnings = list(mesh.warnings)
    corners = mesh.corners
    far, times = _far(corners, corners, POSITIONS)
    if far:
        warnings.append(
            f"{far} face(s) lie far from the others, which get 1/{times:.0f} of the "
            f"resolution: remove the face(s), or encode them as an asset of their own"
        )
    has_uv = mesh.has_uv
    uvs = mesh.corner_uvs[has_uv]
    far, times = _far(uvs, corners[has_uv], UVS)
    if far:
        warnings.append(
            f"texture coordinates of {far} face(s) lie far from the others, which get "
            f"1/{times:.0f} of the accuracy: {_cure(uvs)}"
        )
    return replace(mesh, warnings=tuple(warnings))


def _cure(uvs: Float64Array) -> str:
    """What brings the texture coordinates (m, 3, 2) of faces near each other."""
    tiles = float(np.ptp(uvs, axis=1).max())
    if tiles < UVS.far * UVS.least:
        return "move them by whole tiles"
    return f"one face runs over {tiles:.0f} tiles; one image of several tiles makes them fewer"


def _far(values: Float64Array, corners: Float64Array, limits: Limits) -> tuple[int, float]:
    """How many faces, if few, make the extent much larger than the others; how many times.

    values (m, 3, d) at the corners (m, 3, 3) of faces. `MOST` faces tell which are common.
    """
    if not len(values):
        return 0, 1.0
    step = slice(None, None, -(-len(values) // MOST))
    some, areas, half = values[step], _areas(corners[step]), limits.few / 2
    low = np.array([_quantile(each, areas, half) for each in some.min(axis=1).T])
    high = np.array([_quantile(each, areas, 1 - half) for each in some.max(axis=1).T])
    extent = max(float((high - low).max()), limits.least)
    whole = max(float(each.max() - each.min()) for each in values.reshape(-1, values.shape[2]).T)
    if whole <= limits.far * extent:
        return 0, 1.0
    off = (values < low - extent) | (values > high + extent)
    far, areas = np.asarray(off.any(axis=(1, 2))), _areas(corners)
    is_few = areas[far].sum() <= limits.few * areas.sum()
    return (int(far.sum()), whole / extent) if is_few and extent > 0 else (0, 1.0)


def _areas(corners: Float64Array) -> Float64Array:
    a, b, c = corners.transpose(1, 0, 2)
    areas: Float64Array = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return areas


def _quantile(values: Float64Array, weights: Float64Array, share: float) -> float:
    """The value below which `share` of the weight lies."""
    order = np.argsort(values)
    reached = np.cumsum(weights[order])
    place = int(np.searchsorted(reached, share * reached[-1]))
    return float(values[order[min(place, len(order) - 1)]])
