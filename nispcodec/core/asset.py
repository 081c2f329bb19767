"""The textured triangle mesh that goes in and comes out: geometry, materials, textures.

UV coordinates have their origin bottom-left, as in OBJ; readers and writers of other conventions
convert at the border of the program. Positions are in the world frame, in the units of the file.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from nispcodec.core.arrays import AnyArray, BoolArray, Float64Array, Int32Array, IntArray
from nispcodec.core.errors import MeshError
from nispcodec.core.progress import warn
from nispcodec.core.slots import SLOTS

WRAPS = ("repeat", "clamp", "mirror")
FILTERS = ("linear", "nearest")
ALPHA_MODES = ("opaque", "mask", "blend")
_CONTROL = re.compile(r"[\x00-\x1f\x7f\ud800-\udfff]")
MIME_TYPES = ("image/png", "image/jpeg", "image/webp", "image/avif")


@dataclass(frozen=True)
class Texture:
    """One image as the bytes of an image file.

    `name` is a bare file name ("wood.png"), `mime` one of `MIME_TYPES`.
    """

    name: str
    data: bytes = field(repr=False)
    mime: str


@dataclass(frozen=True)
class TextureMap:
    """How a material uses a texture in one slot.

    `texture` indexes the asset's textures; `wrap` is for u and v, each one of `WRAPS`; `filter` is
    one of `FILTERS`; `strength` is glTF's normal scale or occlusion strength.
    """

    texture: int
    wrap: tuple[str, str] = ("repeat", "repeat")
    filter: str = "linear"
    strength: float = 1.0


@dataclass(frozen=True)
class Material:
    """Metallic-roughness material as in glTF 2.0, its factors linear and in [0, 1].

    `base_color` is RGBA; `alpha_mode` is one of `ALPHA_MODES`, and `alpha_cutoff` the least alpha
    that "mask" shows; `maps` goes from slot (`nispcodec.core.slots`) to map.
    """

    name: str = "material"
    base_color: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0)
    metallic: float = 0.0
    roughness: float = 1.0
    emissive: tuple[float, float, float] = (0.0, 0.0, 0.0)
    alpha_mode: str = "opaque"
    alpha_cutoff: float = 0.5
    double_sided: bool = False
    maps: Mapping[str, TextureMap] = field(default_factory=dict)


@dataclass(frozen=True)
class TexturedMesh:
    """One asset: triangles with a UV coordinate for each corner and a material for each face.

    positions      (n, 3) float64, world frame
    faces          (m, 3) int32, into positions
    uvs            (t, 2) float64, origin bottom-left, any range
    uv_faces       (m, 3) int32, into uvs; a face without UV has -1 in all three corners
    face_materials (m,)   int32, into materials
    warnings       what the reader had to leave out or guess, one sentence each
    creases        (m, 3) bool: whether shading breaks over the side from corner i to corner i + 1,
                   which is alike for all sides between two positions; None: nobody said

    Raises MeshError for an array of another shape or type, a number that is not finite, an index
    out of range, a material's name with control characters, and a map, wrap, filter or alpha mode
    that there is none of.
    """

    positions: Float64Array
    faces: Int32Array
    uvs: Float64Array
    uv_faces: Int32Array
    face_materials: Int32Array
    materials: tuple[Material, ...] = (Material(),)
    textures: tuple[Texture, ...] = ()
    name: str = "mesh"
    warnings: tuple[str, ...] = ()
    creases: BoolArray | None = None

    def __post_init__(self) -> None:
        faces = len(self.faces)
        _expect("positions", self.positions, (None, 3), np.float64)
        _expect("faces", self.faces, (None, 3), np.int32)
        _expect("uvs", self.uvs, (None, 2), np.float64)
        _expect("uv_faces", self.uv_faces, (faces, 3), np.int32)
        _expect("face_materials", self.face_materials, (faces,), np.int32)
        if self.creases is not None:
            _expect("creases", self.creases, (faces, 3), np.bool_)
        _expect_range("faces", self.faces, 0, len(self.positions))
        _expect_range("uv_faces", self.uv_faces, -1, len(self.uvs))
        _expect_range("face_materials", self.face_materials, 0, len(self.materials))
        for material in self.materials:
            _expect_material(material, len(self.textures))

    def save(self, path: str | Path) -> list[Path]:
        """Write the mesh in the format of the path's suffix -> the files written.

        Warns and raises as `nispcodec.write_mesh` does.
        """
        from nispcodec.io.save import losses, write_mesh

        files = write_mesh(self, path)
        warn(losses(self, path))
        return files

    @staticmethod
    def geometry_only(positions: Float64Array, faces: IntArray, name: str) -> TexturedMesh:
        """A mesh of positions (n, 3) and faces (m, 3) without UVs, of one material.

        Raises MeshError as the class does.
        """
        return TexturedMesh(
            positions=positions,
            faces=faces.astype(np.int32),
            uvs=np.zeros((0, 2)),
            uv_faces=np.full(faces.shape, -1, dtype=np.int32),
            face_materials=np.zeros(len(faces), dtype=np.int32),
            name=name,
        )

    def only(self, chosen: BoolArray) -> TexturedMesh:
        """The chosen faces (m,) bool; positions, UVs and materials are all kept."""
        return replace(
            self,
            faces=self.faces[chosen],
            uv_faces=self.uv_faces[chosen],
            face_materials=self.face_materials[chosen],
            creases=None if self.creases is None else self.creases[chosen],
        )

    @property
    def corners(self) -> Float64Array:
        """(m, 3, 3) float64: the positions of every face's corners."""
        return self.positions[self.faces]

    @property
    def corner_uvs(self) -> Float64Array:
        """(m, 3, 2) float64: the UVs of every face's corners; zeros where a face has none."""
        return self.uvs_at(slice(None))

    def uvs_at(self, faces: IntArray | slice) -> Float64Array:
        """(n, 3, 2) float64: the same of some faces."""
        padded = np.vstack([self.uvs, np.zeros((1, 2))])
        return padded[self.uv_faces[faces]]

    @property
    def has_uv(self) -> BoolArray:
        """(m,) bool: which faces carry UVs."""
        return np.asarray((self.uv_faces >= 0).all(axis=1))


def _expect(name: str, array: AnyArray, shape: tuple[int | None, ...], dtype: type) -> None:
    shape_fits = array.ndim == len(shape) and all(
        want is None or want == got for want, got in zip(shape, array.shape, strict=True)
    )
    if not shape_fits or array.dtype != dtype:
        raise MeshError(
            f"{name}: expected shape {shape} of {np.dtype(dtype)}, "
            f"found shape {array.shape} of {array.dtype}"
        )
    if dtype is np.float64 and not np.isfinite(array).all():
        raise MeshError(f"{name}: expected finite numbers, found NaN or infinity")


def _expect_material(material: Material, textures: int) -> None:
    place = f"material {material.name!r}"
    if _CONTROL.search(material.name):
        raise MeshError(f"{place}: expected a name without control characters")
    _expect_member(f"{place}: alpha mode", material.alpha_mode, ALPHA_MODES)
    for slot, used in material.maps.items():
        _expect_member(f"{place}: slot", slot, SLOTS)
        _expect_member(f"{place}.{slot}: filter", used.filter, FILTERS)
        for wrap in used.wrap:
            _expect_member(f"{place}.{slot}: wrap", wrap, WRAPS)
        if not 0 <= used.texture < textures:
            raise MeshError(
                f"{place}.{slot}: expected a texture below {textures}, found {used.texture}"
            )


def _expect_member(place: str, found: str, members: tuple[str, ...]) -> None:
    if found not in members:
        raise MeshError(f"{place}: expected one of {', '.join(members)}, found {found!r}")


def _expect_range(name: str, indices: Int32Array, low: int, high: int) -> None:
    if indices.size and (indices.min() < low or indices.max() >= high):
        raise MeshError(
            f"{name}: expected indices from {low} to {high - 1}, "
            f"found {indices.min()} to {indices.max()}"
        )
