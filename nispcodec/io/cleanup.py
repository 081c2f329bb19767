"""Clean-up common to all readers: faces and vertices without surface are dropped and counted."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int32Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.connectivity import row_ids
from nispcodec.core.counted import counted
from nispcodec.core.errors import MeshError

# A triangle lower than this share of its longest edge is a line.
FLATTEST = 1e-10
# And where all are lower than this, no distance to them can be told (nispcodec.metrics.surface).
NO_AREA = 1e-7
# Squares of larger coordinates' differences would leave float32 and soon float64.
LARGEST_COORDINATE = 1e15
# Warnings that an error ends with.
_MOST_SAID = 5


def clean(mesh: TexturedMesh, name: str) -> TexturedMesh:
    """Drop degenerate faces, exact duplicates, then vertices and UVs that no face uses.

    Each kind is counted in `warnings`. Vertices of equal position are not merged. Raises MeshError
    naming the file `name` and what its reader left out, when no face is left or a coordinate of one
    is too large to compute with.
    """
    if not len(mesh.faces):
        raise _error(mesh, f"{name}: expected at least one face, found none")
    _expect_moderate(mesh.corners, name)
    heights = _heights(mesh)
    if heights.max() <= NO_AREA:
        found = counted(len(heights), "degenerate face")
        raise _error(mesh, f"{name}: expected faces with an area, found {found}")
    mesh = _drop_faces(mesh, heights <= FLATTEST, "degenerate")
    mesh = _drop_faces(mesh, duplicate_faces(mesh), "duplicate")
    return _drop_unreferenced(mesh)


def _heights(mesh: TexturedMesh) -> Float64Array:
    """(m,) of every face its height over the longest edge, in lengths of that edge.

    0 where a face repeats a position; rounding leaves lines up to `FLATTEST`.
    """
    edges = np.roll(mesh.corners, -1, axis=1) - mesh.corners
    longest = np.linalg.norm(edges, axis=2).max(axis=1)
    scaled = edges / np.where(longest > 0, longest, 1.0)[:, None, None]
    heights: Float64Array = np.linalg.norm(np.cross(scaled[:, 0], scaled[:, 1]), axis=1)
    return heights


def duplicate_faces(mesh: TexturedMesh) -> BoolArray:
    """(m,) bool: which faces equal an earlier one in positions, orientation, UVs and material."""
    # Adding zero makes -0 and 0 the same bits.
    position = row_ids(mesh.positions + 0.0)[mesh.faces]
    uv = np.append(row_ids(mesh.uvs + 0.0), -1)[mesh.uv_faces]
    corners = np.stack([position, uv], axis=2)
    first = np.argmin(corners[:, :, 0], axis=1)
    turned = np.take_along_axis(corners, ((first[:, None] + [0, 1, 2]) % 3)[:, :, None], axis=1)
    keys = np.hstack([turned.reshape(-1, 6), mesh.face_materials[:, None]])
    order = np.lexsort(keys.T)  # stable: of equal ones the earliest comes first
    repeated = np.zeros(len(keys), dtype=bool)
    repeated[order[1:]] = (keys[order[1:]] == keys[order[:-1]]).all(axis=1)
    return repeated


def _error(mesh: TexturedMesh, what: str) -> MeshError:
    """The error with what was left out of the mesh, which may be what is missing."""
    if not mesh.warnings:
        return MeshError(what)
    said = "; ".join(mesh.warnings[:_MOST_SAID])
    return MeshError(f"{what} ({said}{'; ...' if mesh.warnings[_MOST_SAID:] else ''})")


def _expect_moderate(positions: Float64Array, name: str) -> None:
    largest = np.abs(positions).max()
    if largest > LARGEST_COORDINATE:
        raise MeshError(
            f"{name}: expected coordinates up to {LARGEST_COORDINATE:g}, found {largest:g}"
        )


def _drop_faces(mesh: TexturedMesh, dropped: BoolArray, kind: str) -> TexturedMesh:
    if not dropped.any():
        return mesh
    return replace(
        mesh,
        faces=mesh.faces[~dropped],
        uv_faces=mesh.uv_faces[~dropped],
        face_materials=mesh.face_materials[~dropped],
        creases=None if mesh.creases is None else mesh.creases[~dropped],
        warnings=(*mesh.warnings, f"dropped {counted(int(dropped.sum()), f'{kind} face')}"),
    )


def _drop_unreferenced(mesh: TexturedMesh) -> TexturedMesh:
    positions, faces = _compact(mesh.positions, mesh.faces)
    uvs, uv_faces = _compact(mesh.uvs, mesh.uv_faces)
    lost = {
        "unreferenced vertex": len(mesh.positions) - len(positions),
        "unreferenced texture coordinate": len(mesh.uvs) - len(uvs),
    }
    said = tuple(f"dropped {counted(count, kind)}" for kind, count in lost.items() if count)
    return replace(
        mesh,
        positions=positions,
        faces=faces,
        uvs=uvs,
        uv_faces=uv_faces,
        warnings=mesh.warnings + said,
    )


def _compact(rows: Float64Array, faces: Int32Array) -> tuple[Float64Array, Int32Array]:
    """Keep the rows that faces use, in their order; index -1 stays -1."""
    used = np.zeros(len(rows) + 1, dtype=bool)
    used[faces] = True
    used[-1] = False
    numbers = np.append(np.cumsum(used[:-1]) - 1, -1).astype(np.int32)
    return rows[used[:-1]], numbers[faces]
