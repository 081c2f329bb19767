"""glTF 2.0 and GLB: the meshes of the default scene, in world coordinates."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from nispcodec.core.arrays import Float64Array, Int32Array, Int64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.errors import MeshError
from nispcodec.io.folder import Folder
from nispcodec.io.read.gltf_buffers import Buffers, split_glb
from nispcodec.io.read.gltf_json import Element, parse_json
from nispcodec.io.read.gltf_materials import GltfMaterials, UvSource

_READABLE = {
    "KHR_texture_transform",
    "KHR_mesh_quantization",
    "KHR_lights_punctual",
    "EXT_texture_webp",
    "EXT_texture_avif",
}
_COMPRESSED = {
    "KHR_draco_mesh_compression",
    "EXT_meshopt_compression",
    "KHR_meshopt_compression",
}
_TRIANGLES, _STRIP, _FAN = 4, 5, 6
# Instances multiply what a small file holds: no more vertices or faces than this.
LARGEST = 20_000_000


def read_gltf(data: bytes, name: str, folder: Folder) -> TexturedMesh:
    """Parse a .gltf or .glb file, and the buffers and images that it names in `folder`.

    Node transforms are applied; UVs get their origin bottom-left. Raises MeshError, naming the file
    `name` and the JSON path, for whatever glTF 2.0 does not allow, and for compressed meshes.
    """
    text, binary = split_glb(data, name)
    root = parse_json(text, name)
    _expect_readable(root)
    warnings = _things_left_out(root)
    buffers = Buffers(root, binary, folder)
    scene = _Scene(buffers, GltfMaterials(root, buffers, folder, warnings), warnings)
    for number, (mesh, matrix) in enumerate(_instances(root)):
        for primitive in mesh.entries("primitives"):
            scene.add(primitive, matrix, number)
    return scene.mesh()


def _expect_readable(root: Element) -> None:
    version = root.need("asset").text("version", "")
    if not version.startswith("2."):
        root.fail("glTF version 2", version)
    for extension in root.texts("extensionsRequired"):
        if extension in _COMPRESSED:
            root.fail("an uncompressed mesh (export it again without compression)", extension)
        if extension not in _READABLE and not extension.startswith("KHR_materials_"):
            root.fail("only extensions that we can read", extension)


def _things_left_out(root: Element) -> list[str]:
    kinds = {"animations": "animations", "skins": "skins, taking the bind pose"}
    return [f"{root.file}: left out {what}" for key, what in kinds.items() if root.entries(key)]


def _instances(root: Element) -> Iterator[tuple[Element, Float64Array]]:
    """Each mesh of the scene with its world matrix (4, 4), depth first."""
    stack = [(index, np.eye(4)) for index in reversed(_root_nodes(root))]
    seen = set()
    while stack:
        index, parent = stack.pop()
        node = root.entry("nodes", index)
        if index in seen:
            node.fail("a node with one parent", "several, or a cycle")
        seen.add(index)
        matrix = parent @ _local_matrix(node)
        mesh = node.optional("mesh")
        if mesh is not None:
            # A skin replaces the transform of its node.
            skinned = node.get("skin") is not None
            yield root.entry("meshes", mesh), np.eye(4) if skinned else matrix
        children = _indices(node, "children")
        stack.extend((child, matrix) for child in reversed(children))


def _root_nodes(root: Element) -> list[int]:
    if root.entries("scenes"):
        return _indices(root.entry("scenes", root.integer("scene", 0)), "nodes")
    nodes = root.entries("nodes")
    children = {child for node in nodes for child in _indices(node, "children")}
    return [index for index in range(len(nodes)) if index not in children]


def _indices(owner: Element, key: str) -> list[int]:
    array = owner.get(key)
    values = [] if array is None else array.value
    if not isinstance(values, list) or not all(type(value) is int for value in values):
        owner.fail(f"node indices in {key}", values)
    return values


def _local_matrix(node: Element) -> Float64Array:
    if node.get("matrix") is not None:
        flat = node.numbers("matrix", np.eye(4).reshape(-1).tolist())
        return np.array(flat).reshape(4, 4).T
    x, y, z, w = node.numbers("rotation", (0.0, 0.0, 0.0, 1.0))
    matrix = np.eye(4)
    matrix[:3, :3] = _rotation(np.array([x, y, z, w])) * node.numbers("scale", (1.0, 1.0, 1.0))
    matrix[:3, 3] = node.numbers("translation", (0.0, 0.0, 0.0))
    return matrix


def _rotation(quaternion: Float64Array) -> Float64Array:
    """(x, y, z, w) -> (3, 3); exporters round, so it need not have length one."""
    length = np.linalg.norm(quaternion)
    x, y, z, w = quaternion / (length if length > 0 else 1.0)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


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

    def __init__(self, buffers: Buffers, materials: GltfMaterials, warnings: list[str]) -> None:
        self._buffers = buffers
        self._materials = materials
        self._warnings = warnings
        self._positions = _Rows()
        self._uvs = _Rows()
        self._faces: list[Int64Array] = []
        self._uv_faces: list[Int64Array] = []
        self._face_materials: list[Int64Array] = []
        self._count = 0

    def add(self, primitive: Element, matrix: Float64Array, instance: int) -> None:
        """Add one primitive; `instance` numbers the matrices."""
        attributes = primitive.need("attributes")
        mode = primitive.integer("mode", _TRIANGLES)
        if mode not in (_TRIANGLES, _STRIP, _FAN) or attributes.get("POSITION") is None:
            self._warn(f"{primitive.place}: left out, not a primitive of triangles")
            return
        first, count = self._place_positions(attributes, matrix, instance)
        faces = _triangles(self._corner_indices(primitive, count), mode, primitive)
        if np.linalg.det(matrix[:3, :3]) < 0:
            faces = faces[:, [0, 2, 1]]
        material, source = self._materials.use(primitive.optional("material"))
        uv_first = self._place_uvs(attributes, source, count)
        self._faces.append(faces + first)
        self._uv_faces.append(np.full_like(faces, -1) if uv_first is None else faces + uv_first)
        self._face_materials.append(np.full(len(faces), material))
        self._count += len(faces)
        self._expect_moderate(primitive)
        self._warn_of_losses(primitive, attributes)

    def mesh(self) -> TexturedMesh:
        return TexturedMesh(
            positions=self._positions.table(3),
            faces=_stacked(self._faces, (0, 3)),
            uvs=self._uvs.table(2),
            uv_faces=_stacked(self._uv_faces, (0, 3)),
            face_materials=_stacked(self._face_materials, (0,)),
            materials=self._materials.materials,
            textures=tuple(self._materials.shelf.textures),
            warnings=tuple(self._warnings),
        )

    def _place_positions(
        self, attributes: Element, matrix: Float64Array, instance: int
    ) -> tuple[int, int]:
        """First row and number of rows; primitives of an instance often share an accessor."""
        accessor = attributes.integer("POSITION")
        local = self._buffers.numbers(accessor, 3)
        key = (instance, accessor)
        if key not in self._positions.starts:
            identity = np.array_equal(matrix, np.eye(4))
            world = local if identity else local @ matrix[:3, :3].T + matrix[:3, 3]
            if not np.isfinite(world).all():
                attributes.fail("finite world coordinates", "overflow in node transforms")
            self._positions.add(key, world)
        return self._positions.starts[key], len(local)

    def _place_uvs(self, attributes: Element, source: UvSource, count: int) -> int | None:
        accessor = attributes.optional(f"TEXCOORD_{source.texcoord}")
        if accessor is None:
            return None
        stored = self._buffers.numbers(accessor, 2)
        if len(stored) != count:
            attributes.fail(f"{count} texture coordinates", len(stored))
        key = (accessor, source)
        if key not in self._uvs.starts:
            uvs = source.apply(stored)
            if not np.isfinite(uvs).all():
                attributes.fail("finite texture coordinates", "overflow in the texture transform")
            self._uvs.add(key, np.column_stack([uvs[:, 0], 1.0 - uvs[:, 1]]))
        return self._uvs.starts[key]

    def _corner_indices(self, primitive: Element, count: int) -> Int64Array:
        accessor = primitive.optional("indices")
        if accessor is None:
            return np.arange(count)
        indices = self._buffers.indices(accessor)
        if indices.size and indices.max() >= count:
            primitive.fail(f"vertex indices below {count}", int(indices.max()))
        return indices

    def _expect_moderate(self, primitive: Element) -> None:
        largest = max(self._count, self._positions.count, self._uvs.count)
        if largest > LARGEST:
            raise MeshError(
                f"{primitive.place}: expected at most {LARGEST} faces and vertices in all, "
                f"found {largest}"
            )

    def _warn_of_losses(self, primitive: Element, attributes: Element) -> None:
        if attributes.get("COLOR_0") is not None:
            self._warn(f"{primitive.file}: left out vertex colors")
        if primitive.get("targets") is not None:
            self._warn(f"{primitive.file}: left out morph targets")

    def _warn(self, warning: str) -> None:
        if warning not in self._warnings:
            self._warnings.append(warning)


def _triangles(indices: Int64Array, mode: int, primitive: Element) -> Int64Array:
    """(n,) corner indices -> (m, 3) faces; glTF 2.0, section 3.7.2.1."""
    if mode == _TRIANGLES:
        if len(indices) % 3:
            primitive.fail("a multiple of 3 indices", len(indices))
        return indices.reshape(-1, 3)
    first = np.arange(max(len(indices) - 2, 0))
    if mode == _FAN:
        return indices[np.stack([first + 1, first + 2, np.zeros_like(first)], axis=1)]
    odd = first % 2
    return indices[np.stack([first, first + 1 + odd, first + 2 - odd], axis=1)]


def _stacked(arrays: list[Int64Array], shape: tuple[int, ...]) -> Int32Array:
    return np.concatenate([np.zeros(shape, dtype=np.int64), *arrays]).astype(np.int32)
