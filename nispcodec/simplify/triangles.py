"""Welded triangles in the normalized frame, with their patches and bodies: to be simplified."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int32Array, Int64Array, IntArray
from nispcodec.core.asset import Material, TexturedMesh
from nispcodec.core.connectivity import connected_faces, row_ids
from nispcodec.core.document import Frame
from nispcodec.core.errors import MeshError
from nispcodec.geometry.welding import welded


@dataclass(frozen=True)
class Triangles:
    """m triangles whose corners are welded: equal positions, and UVs on one patch, are one.

    positions  (n, 3) float64, normalized frame
    faces      (m, 3) int64, into positions
    uvs        (t, 2) float64, the asset's UVs; corners of other patches have others
    uv_faces   (m, 3) int64, into uvs; -1 in all three corners of a face without UV
    materials  (m,) int32
    patches    (m,) int32: faces that corners of one material connect share a number
    sheet      (m,) bool: faces of open sheets
    creases    (m, 3) bool: whether shading breaks over the side from corner i to i + 1; None:
               nobody said
    """

    positions: Float64Array
    faces: Int64Array
    uvs: Float64Array
    uv_faces: Int64Array
    materials: Int32Array
    patches: Int32Array
    sheet: BoolArray
    creases: BoolArray | None = None

    @staticmethod
    def of(
        mesh: TexturedMesh,
        frame: Frame,
        chosen: BoolArray | None = None,
        sheet: BoolArray | None = None,
    ) -> Triangles:
        """The `chosen` faces (m,) bool of a mesh in the world frame; all faces if None.

        sheet: (m,) bool, the faces of open sheets; if None, those of bodies with a border.
        Faces two of whose corners fall together are left out. Raises MeshError where no face
        remains.
        """
        welding = welded(mesh)
        kept = distinct(welding.positions)
        if chosen is not None:
            kept &= chosen
        if not kept.any():
            raise MeshError(f"{mesh.name}: expected faces to simplify, found none")
        positions = np.zeros((int(welding.positions.max()) + 1, 3))
        positions[welding.positions] = frame.to_normalized(mesh.positions)[mesh.faces]
        uvs = np.zeros((int(welding.corners.max()) + 1, 2))
        uvs[welding.corners] = mesh.corner_uvs
        triangles = Triangles(
            positions=positions,
            faces=welding.positions[kept],
            uvs=uvs,
            uv_faces=np.where(mesh.has_uv[:, None], welding.corners, -1)[kept],
            materials=mesh.face_materials[kept],
            patches=welding.patches[kept],
            sheet=np.zeros(int(kept.sum()), np.bool_) if sheet is None else sheet[kept],
            creases=None if mesh.creases is None else mesh.creases[kept],
        ).compact()
        return triangles if sheet is not None else replace(triangles, sheet=_open(triangles))

    def __len__(self) -> int:
        return len(self.faces)

    def only(self, chosen: BoolArray | IntArray) -> Triangles:
        """Some of the faces, and of positions and UVs those in use."""
        return replace(
            self,
            faces=self.faces[chosen],
            uv_faces=self.uv_faces[chosen],
            materials=self.materials[chosen],
            patches=self.patches[chosen],
            sheet=self.sheet[chosen],
            creases=None if self.creases is None else self.creases[chosen],
        ).compact()

    def compact(self) -> Triangles:
        """Without positions and UVs that no face uses."""
        used, faces = np.unique(self.faces, return_inverse=True)
        dressed = self.has_uv
        used_uvs, uv_faces = np.unique(self.uv_faces[dressed], return_inverse=True)
        every = np.full(self.faces.shape, -1, np.int64)
        every[dressed] = uv_faces.reshape(-1, 3)
        return replace(
            self,
            positions=self.positions[used],
            faces=faces.reshape(-1, 3),
            uvs=self.uvs[used_uvs],
            uv_faces=every,
        )

    @property
    def has_uv(self) -> BoolArray:
        """(m,) bool: which faces carry UVs."""
        return np.asarray(self.uv_faces[:, 0] >= 0)

    @cached_property
    def bodies(self) -> Int32Array:
        """(m,) int32: faces that positions connect share a number."""
        return connected_faces(self.faces)

    @property
    def corners(self) -> Float64Array:
        """(m, 3, 3): the positions of every face's corners."""
        return self.positions[self.faces]

    @property
    def corner_uvs(self) -> Float64Array:
        """(m, 3, 2): the UVs of every face's corners; zeros where a face has none."""
        return np.vstack([self.uvs, np.zeros((1, 2))])[self.uv_faces]

    def mesh(self) -> TexturedMesh:
        """The same as a mesh whose positions are in the normalized frame, of nameless materials."""
        return TexturedMesh(
            positions=self.positions,
            faces=self.faces.astype(np.int32),
            uvs=self.uvs,
            uv_faces=self.uv_faces.astype(np.int32),
            face_materials=self.materials,
            materials=(Material(),) * (int(self.materials.max()) + 1),
        )


def joined(*pieces: Triangles) -> Triangles:
    """All of them, which share no corner."""
    positions = np.cumsum([0, *(len(piece.positions) for piece in pieces)])
    uvs = np.cumsum([0, *(len(piece.uvs) for piece in pieces)])
    faces = [piece.faces + at for piece, at in zip(pieces, positions, strict=False)]
    uv_faces = [
        np.where(piece.uv_faces < 0, -1, piece.uv_faces + at)
        for piece, at in zip(pieces, uvs, strict=False)
    ]
    return Triangles(
        positions=np.concatenate([piece.positions for piece in pieces]),
        faces=np.concatenate(faces),
        uvs=np.concatenate([piece.uvs for piece in pieces]),
        uv_faces=np.concatenate(uv_faces),
        materials=np.concatenate([piece.materials for piece in pieces]),
        patches=np.concatenate([piece.patches for piece in pieces]),
        sheet=np.concatenate([piece.sheet for piece in pieces]),
        creases=_all_creases(pieces),
    )


def _all_creases(pieces: Sequence[Triangles]) -> BoolArray | None:
    known = [piece.creases for piece in pieces if piece.creases is not None]
    return np.concatenate(known) if len(known) == len(pieces) else None


def distinct_corners(mesh: TexturedMesh) -> BoolArray:
    """(m,) bool: the faces of a mesh that `Triangles.of` takes, whose corners all differ."""
    return distinct(row_ids(mesh.positions)[mesh.faces])


def distinct(corners: Int64Array) -> BoolArray:
    """(m, 3) numbers -> (m,) bool: whether all three differ."""
    return np.asarray((corners != np.roll(corners, 1, axis=1)).all(axis=1))


def _open(triangles: Triangles) -> BoolArray:
    """(m,) bool: faces of bodies that have an edge of one face only."""
    edges = side_numbers(triangles.faces)
    border = (np.bincount(edges.ravel())[edges] == 1).any(axis=1)
    bodies = triangles.bodies
    is_open = np.zeros(int(bodies.max()) + 1, np.bool_)
    is_open[bodies[border]] = True
    return is_open[bodies]


def side_numbers(faces: Int64Array) -> Int64Array:
    """(m, 3) corners -> (m, 3): the edge of the side from each corner to the next, from 0 up."""
    ends = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2), axis=2)
    return row_ids(ends.reshape(-1, 2)).reshape(-1, 3)
