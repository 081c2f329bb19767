"""glTF 2.0 and GLB: the meshes of the default scene, in world coordinates."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from nispcodec.core.arrays import Float32Array, Float64Array, Int64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.errors import MeshError
from nispcodec.io.folder import Folder
from nispcodec.io.read.coordinates import without_unusable
from nispcodec.io.read.gltf_buffers import Buffers, split_glb
from nispcodec.io.read.gltf_draco import EXTENSION as DRACO
from nispcodec.io.read.gltf_draco import DracoPrimitives
from nispcodec.io.read.gltf_json import LARGEST, Element, parse_json
from nispcodec.io.read.gltf_materials import GltfMaterials, SameUvs, UvSource
from nispcodec.io.read.gltf_meshopt import EXTENSIONS as MESHOPT
from nispcodec.io.read.gltf_nodes import Shown, shown_meshes, skinned
from nispcodec.io.read.normals import with_creases

# The last three change nothing of what an asset looks like at rest.
_READABLE = {
    "KHR_texture_transform",
    "KHR_mesh_quantization",
    "EXT_texture_webp",
    "EXT_texture_avif",
    "EXT_mesh_gpu_instancing",
    "KHR_node_visibility",
    "KHR_texture_basisu",
    DRACO,
    *MESHOPT,
    "KHR_lights_punctual",
    "KHR_animation_pointer",
    "KHR_xmp_json_ld",
}
_MATERIAL, _VARIANTS = "KHR_materials_", "KHR_materials_variants"
_TRIANGLES, _STRIP, _FAN = 4, 5, 6


def read_gltf(data: bytes, name: str, folder: Folder) -> TexturedMesh:
    """Parse a .gltf or .glb file, and the buffers and images that it names in `folder`.

    Node transforms are applied; UVs get their origin bottom-left. Raises MeshError, naming the file
    `name` and the JSON path, for whatever glTF 2.0 does not allow; NispError for a compressed file
    without the extra `gltf`.
    """
    warnings: list[str] = []
    text, binary = split_glb(data, name, warnings)
    root = parse_json(text, name)
    _expect_readable(root)
    warnings += _things_left_out(root)
    buffers = Buffers(root, binary, folder)
    materials = GltfMaterials(root, buffers, folder, warnings)
    scene = _Scene(buffers, materials, DracoPrimitives(root, buffers, warnings), warnings)
    for number, shown in enumerate(shown_meshes(root, buffers, warnings)):
        for primitive in shown.mesh.entries("primitives"):
            scene.add(primitive, shown, number)
    return scene.mesh(root)


def _expect_readable(root: Element) -> None:
    version = root.need("asset").text("version", "")
    if not version.startswith("2."):
        root.fail("glTF version 2", version)
    for extension in root.texts("extensionsRequired"):
        if extension not in _READABLE and not extension.startswith(_MATERIAL):
            root.fail("only extensions that we can read", extension)


def _things_left_out(root: Element) -> list[str]:
    kinds = {"animations": "animations", "skins": "skins, taking the bind pose"}
    left_out = [what for key, what in kinds.items() if root.entries(key)]
    # Those of materials are named where a material has them.
    left_out += [
        f"extension {name!r}"
        for name in dict.fromkeys(root.texts("extensionsUsed"))
        if name not in _READABLE and (name == _VARIANTS or not name.startswith(_MATERIAL))
    ]
    return [f"{root.file}: left out {what}" for what in left_out]


@dataclass
class _Rows:
    """Rows of several arrays, each array taken once, as one table."""

    arrays: list[Float64Array] = field(default_factory=list)
    starts: dict[object, int] = field(default_factory=dict)
    count: int = 0

    def add(self, key: object, rows: Float64Array) -> None:
        self.starts[key] = self.count
        self.arrays.append(rows)
        self.count += len(rows)

    def table(self, width: int) -> Float64Array:
        return np.concatenate([np.zeros((0, width)), *self.arrays])


class _Scene:
    """The primitives of a scene, collected into one mesh."""

    def __init__(
        self,
        buffers: Buffers,
        materials: GltfMaterials,
        draco: DracoPrimitives,
        warnings: list[str],
    ) -> None:
        self._buffers = buffers
        self._materials = materials
        self._draco = draco
        self._warnings = warnings
        self._positions = _Rows()
        self._uvs = _Rows()
        self._faces: list[Int64Array] = []
        self._uv_faces: list[Int64Array] = []
        self._face_materials: list[Int64Array] = []
        self._normals: list[Float32Array] = []
        self._count = 0

    def add(self, primitive: Element, shown: Shown, number: int) -> None:
        """Add one primitive of a node; `number` counts the nodes."""
        attributes = primitive.need("attributes")
        mode = primitive.integer("mode", _TRIANGLES)
        if mode not in (_TRIANGLES, _STRIP, _FAN) or attributes.get("POSITION") is None:
            self._warn(f"{primitive.place}: left out, not a primitive of triangles")
            return
        unpacked = self._draco.unpack(primitive)  # before anything asks for its accessors
        if unpacked is not None:
            mode = _TRIANGLES  # whatever they were before
        count = self._buffers.count(attributes.integer("POSITION"), 3)
        corners = self._corner_indices(primitive, unpacked, count, mode)
        first = self._place_positions(primitive, shown, number, corners)
        once = _triangles(corners, mode)
        self._expect_moderate(primitive, len(shown.matrices) * len(once))
        faces = np.concatenate([np.zeros((0, 3), np.int64), *_turned(once, shown)])
        starts = first + count * np.arange(len(shown.matrices))
        material, source = self._materials.use(
            primitive.optional("material"), _same_uvs(attributes)
        )
        uv_first = self._place_uvs(attributes, source, count, material)
        self._faces.append(faces + np.repeat(starts, len(once))[:, None])
        self._uv_faces.append(np.full_like(faces, -1) if uv_first is None else faces + uv_first)
        self._face_materials.append(np.full(len(faces), material))
        self._normals.append(self._vertex_normals(attributes, count)[faces])
        self._count += len(faces)
        self._warn_of_losses(primitive, attributes)

    def mesh(self, root: Element) -> TexturedMesh:
        """All that was added; the file's `root` names the place in messages."""
        if not self._count:
            why = f" ({'; '.join(self._warnings[:3])})" if self._warnings else ""
            raise MeshError(
                f"{root.place}: expected a visible mesh of triangles in the scene, found none{why}"
            )
        uv_faces = np.concatenate(self._uv_faces)
        uvs, uv_faces = without_unusable(self._uvs.table(2), uv_faces, root.file, self._warnings)
        mesh = TexturedMesh(
            positions=self._positions.table(3),
            faces=np.concatenate(self._faces).astype(np.int32),
            uvs=uvs,
            uv_faces=uv_faces.astype(np.int32),
            face_materials=np.concatenate(self._face_materials).astype(np.int32),
            materials=self._materials.materials,
            textures=tuple(self._materials.shelf.textures),
            warnings=tuple(self._warnings),
        )
        return with_creases(mesh, np.concatenate(self._normals))

    def _vertex_normals(self, attributes: Element, count: int) -> Float32Array:
        """(count, 3); NaN for a primitive without: its faces are flat (glTF 2.0, 3.7.2.1).

        In the node's own frame: they are compared with each other.
        """
        normals = self._rows(attributes, "NORMAL", 3, count)
        if normals is None:
            return np.full((count, 3), np.nan, np.float32)
        return normals.astype(np.float32)

    def _rows(self, attributes: Element, name: str, width: int, count: int) -> Float64Array | None:
        """(count, width) of an attribute; None, with a warning, where there are no such rows.

        What an asset can do without is no reason to refuse it.
        """
        accessor = attributes.optional(name)
        if accessor is None:
            return None
        try:
            rows = self._buffers.numbers(accessor, width, finite=False)
        except MeshError as why:
            self._warn(f"{why}: {name} left out")
            return None
        if len(rows) != count:
            self._warn(
                f"{attributes.place}: expected {count} of {name}, found {len(rows)}: left out"
            )
            return None
        return rows

    def _place_positions(
        self, primitive: Element, shown: Shown, number: int, corners: Int64Array
    ) -> int:
        """The first row; primitives of a node often share an accessor."""
        attributes = primitive.need("attributes")
        accessor = attributes.integer("POSITION")
        morphed = primitive.path if any(shown.weights) else ""
        key = (number, accessor, *_influences(attributes), morphed)
        local = self._buffers.used_numbers(accessor, corners, self._warnings)
        self._expect_moderate(primitive, len(shown.matrices) * len(local))
        if key not in self._positions.starts:
            local = self._morphed(primitive, local, shown.weights, corners)
            if shown.skin is not None:
                local = self._skinned(attributes, local, shown.skin)
            world = _transformed(local, shown.matrices)
            if not np.isfinite(world).all():
                attributes.fail("finite world coordinates", "overflow in node transforms")
            self._positions.add(key, world)
        return self._positions.starts[key]

    def _morphed(
        self,
        primitive: Element,
        local: Float64Array,
        weights: Sequence[float],
        corners: Int64Array,
    ) -> Float64Array:
        """Positions (n, 3) with the morph targets at the weights of the file."""
        for target, weight in zip(primitive.entries("targets"), weights, strict=False):
            accessor = target.optional("POSITION")
            if accessor is None or not weight:
                continue
            moves = self._moves(target, accessor, len(local), corners)
            local = local + weight * moves
        return local

    def _moves(
        self, target: Element, accessor: int, count: int, corners: Int64Array
    ) -> Float64Array:
        """(count, 3) of a morph target."""
        found = self._buffers.count(accessor, 3)
        if found != count:
            target.fail(f"{count} positions", found)
        return self._buffers.used_numbers(accessor, corners, self._warnings)

    def _skinned(
        self, attributes: Element, local: Float64Array, matrices: Float64Array
    ) -> Float64Array:
        """Positions (n, 3) by the joints of each; unchanged without joints."""
        pairs = _influences(attributes)
        if not pairs:
            return local
        read = [
            (self._buffers.integers(joints, 4), self._buffers.numbers(weights, 4))
            for joints, weights in pairs
        ]
        counts = {len(each) for pair in read for each in pair}
        if counts != {len(local)}:
            attributes.fail(f"{len(local)} joints and weights", sorted(counts))
        joints, weights = (np.hstack(each) for each in zip(*read, strict=True))
        used = joints[weights != 0]
        if used.size and used.max() >= len(matrices):
            attributes.fail(f"joints below {len(matrices)}", int(used.max()))
        return skinned(local, matrices, np.where(weights != 0, joints, 0), weights)

    def _place_uvs(
        self, attributes: Element, source: UvSource, count: int, material: int
    ) -> int | None:
        if attributes.get(f"TEXCOORD_{source.texcoord}") is None:
            source = self._other_source(attributes, source, material)
        name = f"TEXCOORD_{source.texcoord}"
        stored = self._rows(attributes, name, 2, count)
        if stored is None:
            return None
        key = (attributes.integer(name), source)
        if key not in self._uvs.starts:
            uvs = source.apply(stored)
            self._uvs.add(key, np.column_stack([uvs[:, 0], 1.0 - uvs[:, 1]]))
        return self._uvs.starts[key]

    def _other_source(self, attributes: Element, source: UvSource, material: int) -> UvSource:
        """The first texture coordinates in place of missing ones, with a warning."""
        maps = self._materials.materials[material].maps
        found = attributes.get("TEXCOORD_0") is not None
        if maps:
            instead = "TEXCOORD_0 is taken" if found else "its maps are not shown"
            self._warn(
                f"{attributes.place}: no TEXCOORD_{source.texcoord}, which the material looks up: "
                f"{instead}"
            )
        return replace(source, texcoord=0)

    def _corner_indices(
        self, primitive: Element, unpacked: Int64Array | None, count: int, mode: int
    ) -> Int64Array:
        accessor = primitive.optional("indices")
        if unpacked is not None:
            indices = unpacked
        elif accessor is None:
            indices = np.arange(count)
        else:
            indices = self._buffers.indices(accessor)
        if indices.size and indices.max() >= count:
            primitive.fail(f"vertex indices below {count}", int(indices.max()))
        left = len(indices) % 3 if mode == _TRIANGLES else 0
        if left:
            self._warn(f"{primitive.place}: left out {left} corner(s) after the last triangle")
        return indices[: len(indices) - left]

    def _expect_moderate(self, primitive: Element, more: int) -> None:
        largest = max(self._count, self._positions.count, self._uvs.count) + more
        if largest > LARGEST:
            raise MeshError(
                f"{primitive.place}: expected at most {LARGEST} faces and vertices in all, "
                f"found {largest}"
            )

    def _warn_of_losses(self, primitive: Element, attributes: Element) -> None:
        if attributes.get("COLOR_0") is not None:
            self._warn(f"{primitive.file}: left out vertex colors")
        if primitive.get("targets") is not None:
            self._warn(f"{primitive.file}: left out morph targets, taking their default weights")

    def _warn(self, warning: str) -> None:
        if warning not in self._warnings:
            self._warnings.append(warning)


def _same_uvs(attributes: Element) -> SameUvs:
    """The texture coordinates that are there again under another number: light maps' often are."""
    found: list[object] = []
    while (accessor := attributes.get(f"TEXCOORD_{len(found)}")) is not None:
        found.append(accessor.value)
    firsts = enumerate(map(found.index, found))
    return tuple((number, first) for number, first in firsts if number != first)


def _influences(attributes: Element) -> list[tuple[int, int]]:
    """The accessors of joints and weights, four of each vertex in a pair, as many as there are."""
    pairs: list[tuple[int, int]] = []
    while True:
        keys = (f"JOINTS_{len(pairs)}", f"WEIGHTS_{len(pairs)}")
        joints, weights = (attributes.optional(key) for key in keys)
        if joints is None or weights is None:
            return pairs
        pairs.append((joints, weights))


def _transformed(local: Float64Array, matrices: Float64Array) -> Float64Array:
    """Points (n, 3) by each matrix (k, 4, 4), one instance after the other: (k n, 3)."""
    if np.array_equal(matrices, np.eye(4)[None]):
        return local
    with np.errstate(over="ignore", invalid="ignore"):
        world = local @ matrices[:, :3, :3].transpose(0, 2, 1) + matrices[:, None, :3, 3]
    return world.reshape(-1, 3)


def _turned(faces: Int64Array, shown: Shown) -> Iterator[Int64Array]:
    """The faces of each instance, the other way round where it is mirrored."""
    matrices = shown.matrices if shown.skin is None else shown.skin
    mirrored = np.linalg.det(matrices[:, :3, :3]) < 0
    if shown.skin is not None:
        mirrored = np.array([mirrored.size > 0 and bool(mirrored.all())])
    for each in mirrored.tolist():
        yield faces[:, [0, 2, 1]] if each else faces


def _triangles(indices: Int64Array, mode: int) -> Int64Array:
    """(n,) corner indices -> (m, 3) faces; glTF 2.0, section 3.7.2.1."""
    if mode == _TRIANGLES:
        return indices.reshape(-1, 3)
    first = np.arange(max(len(indices) - 2, 0))
    if mode == _FAN:
        return indices[np.stack([first + 1, first + 2, np.zeros_like(first)], axis=1)]
    odd = first % 2
    return indices[np.stack([first, first + 1 + odd, first + 2 - odd], axis=1)]
