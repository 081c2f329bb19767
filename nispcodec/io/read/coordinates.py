"""Texture coordinates as exporters leave them: unusable ones cost their faces, not the asset."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int64Array, IntArray


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
