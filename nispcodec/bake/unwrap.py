"""Make an atlas for a mesh that has none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.core.asset import TexturedMesh
from nispcodec.core.extras import require

ATLAS_SCALE = 1000.0
"""The extent that a mesh is given for xatlas 0.0.11: triangles of less than about 1.2e-7 square
units are degenerate to it, and get UVs of one point; in a unit box those are of many a small part.
"""


def unwrap(mesh: TexturedMesh) -> TexturedMesh:
    """New UVs in [0, 1] without overlaps, by xatlas; faces, positions and materials stay.

    UVs that the mesh has are replaced: its maps no longer fit and are dropped with a warning.
    Raises NispError without the extra `unwrap`.
    """
    require("xatlas", extra="unwrap", what_for="unwrapping")
    import xatlas

    # Far-away coordinates would not survive float32.
    center, radius = mesh.positions.mean(axis=0), np.ptp(mesh.positions, axis=0).max() or 1.0
    moved = ((mesh.positions - center) * (ATLAS_SCALE / radius)).astype(np.float32)
    _, corners, uvs = xatlas.parametrize(moved, mesh.faces.astype(np.uint32))
    return replace(
        _without_maps(mesh),
        uvs=np.asarray(uvs, dtype=np.float64),
        uv_faces=np.asarray(corners, dtype=np.int32),
    )


def with_collapsed_named(mesh: TexturedMesh) -> TexturedMesh:
    """The mesh with a warning for faces that have an area, but none in their UVs."""
    (a, b, c), (p, q, r) = mesh.corner_uvs.transpose(1, 0, 2), mesh.corners.transpose(1, 0, 2)
    u, v = b - a, c - a
    flat = u[:, 0] * v[:, 1] == u[:, 1] * v[:, 0]
    collapsed = int((flat & (np.cross(q - p, r - p) != 0).any(axis=1)).sum())
    if not collapsed:
        return mesh
    warning = (
        f"unwrapping: {collapsed} of {len(mesh.faces)} faces got no area in the atlas, being too "
        f"small for it: scale small parts up, or encode them as an asset of their own"
    )
    return replace(mesh, warnings=(*mesh.warnings, warning))


def _without_maps(mesh: TexturedMesh) -> TexturedMesh:
    if not mesh.textures:
        return mesh
    names = ", ".join(texture.name for texture in mesh.textures)
    plain = tuple(replace(material, maps={}) for material in mesh.materials)
    warning = f"textures fit the old atlas only and are dropped: {names}"
    return replace(mesh, materials=plain, textures=(), warnings=(*mesh.warnings, warning))
