"""Coordinates as exporters leave them: unusable ones cost what uses them, not the asset."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int64Array, IntArray
from nispcodec.core.counted import counted


def without_unused(
    positions: Float64Array, corners: IntArray, place: str, warnings: list[str]
) -> Float64Array:
    """The same positions (n, 3), rows of NaN or infinity 0 where no corner (k,) uses them.

    A new warning, naming the `place`, counts these. Rows that are used stay as they are.
    """
    unused: BoolArray = np.logical_not(np.isfinite(positions).all(axis=1))
    unused[corners] = False
    if not unused.any():
        return positions
    said = (
        f"{place}: left out {counted(int(unused.sum()), 'vertex')} "
        f"without finite coordinates, which no face has"
    )
    if said not in warnings:
        warnings.append(said)
    return np.where(unused[:, None], 0.0, positions)


def without_unusable(
    uvs: Float64Array, uv_faces: IntArray, name: str, warnings: list[str]
) -> tuple[Float64Array, Int64Array]:
    """The same UVs (t, 2) and faces (m, 3), faces that use NaN or infinity without UVs.

    Unusable rows become 0. A new warning, naming the file `name`, counts the faces.
    """
    faces = uv_faces.astype(np.int64)
    finite = np.isfinite(uvs)
    if finite.all():
        return uvs, faces
    usable: BoolArray = np.append(finite[:, 0] & finite[:, 1], True)
    lost = ~(usable[faces[:, 0]] & usable[faces[:, 1]] & usable[faces[:, 2]])
    if lost.any():
        warnings.append(
            f"{name}: texture coordinates of {int(lost.sum())} face(s) are no finite numbers: "
            f"left out"
        )
    return np.where(finite, uvs, 0.0), np.where(lost[:, None], -1, faces)
