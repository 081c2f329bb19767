"""The tree and the buffer of a glTF 2.0 document: one primitive for each material."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any
from urllib.parse import quote

import numpy as np

from nispcodec.core.arrays import AnyArray, Float32Array, IndexArray
from nispcodec.core.asset import Material, Texture, TexturedMesh, TextureMap
from nispcodec.core.slots import BY_NAME, Slot
from nispcodec.core.texture import srgb_to_linear
from nispcodec.io.write.plain_images import MIMES, plain_image
from nispcodec.io.write.tangents import tangents, without_mirrors
from nispcodec.io.write.vertices import Normals, groups, origin, shading_normals, split_vertices

Json = dict[str, Any]

FLOAT, UINT32 = 5126, 5125
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963
WRAPS = {"repeat": 10497, "clamp": 33071, "mirror": 33648}
FILTERS = {"linear": (9729, 9987), "nearest": (9728, 9984)}
WEBP = "EXT_texture_webp"


def gltf_tree(
    mesh: TexturedMesh, colors: Float32Array | None = None, files: Sequence[str] = ()
) -> tuple[Json, bytes]:
    """The mesh as a document with one buffer, and that buffer.

    v is flipped to glTF's top-left origin. A mesh far from the origin gets its place from its node,
    not from its float32 coordinates. Colors (n, 4), sRGB-encoded RGBA of each position, become
    COLOR_0 in linear light. Images are in the buffer, or left to `files`, a name for each texture.
    WebP images are kept (EXT_texture_webp); AVIF ones become PNG, which glTF readers know.
    """
    return _Builder(colors, files).build(mesh)


class _Builder:
    """Collects the JSON tree and the binary buffer that it points into."""

    def __init__(self, colors: Float32Array | None, files: Sequence[str] = ()) -> None:
        self.colors, self.files = colors, files
        self.buffer = bytearray()
        self.tree: Json = {"asset": {"version": "2.0", "generator": "nispcodec"}}
        self.images: dict[int, int] = {}
        self.origin = np.zeros(3)

    def build(self, mesh: TexturedMesh) -> tuple[Json, bytes]:
        self.origin = origin(mesh)
        normals = shading_normals(mesh)
        primitives = [
            self.primitive(mesh, faces, normals, material, has_uv)
            for material, has_uv, faces in groups(mesh)
        ]
        self.tree["scene"] = self.add("scenes", {"nodes": [0], "name": mesh.name})
        node: Json = {"mesh": 0, "name": mesh.name}
        if self.origin.any():
            node["translation"] = self.origin.tolist()
        self.add("nodes", node)
        self.add("meshes", {"primitives": primitives, "name": mesh.name})
        self.pad(b"\0")
        self.tree["buffers"] = [{"byteLength": len(self.buffer)}]
        return self.tree, bytes(self.buffer)

    def add(self, kind: str, item: Json) -> int:
        """Index of the item in the tree's list of that kind; equal items are stored once."""
        items: list[Json] = self.tree.setdefault(kind, [])
        if item not in items:
            items.append(item)
        return items.index(item)

    def pad(self, filler: bytes) -> None:
        self.buffer += filler * (-len(self.buffer) % 4)

    def view(self, data: bytes, target: int | None = None) -> int:
        self.pad(b"\0")
        view: Json = {"buffer": 0, "byteOffset": len(self.buffer), "byteLength": len(data)}
        if target:
            view["target"] = target
        self.buffer += data
        return self.add("bufferViews", view)

    def accessor(self, array: AnyArray, kind: str, target: int) -> int:
        accessor: Json = {
            "bufferView": self.view(array.tobytes(), target),
            "componentType": FLOAT if array.dtype == np.float32 else UINT32,
            "count": array.size if kind == "SCALAR" else len(array),
            "type": kind,
        }
        return self.add("accessors", accessor)

    def primitive(
        self,
        mesh: TexturedMesh,
        faces: IndexArray,
        normals: Normals,
        material: int,
        has_uv: bool,
    ) -> Json:
        bumpy = has_uv and "normal" in mesh.materials[material].maps
        vertices = split_vertices(mesh, faces, normals)
        vertices = without_mirrors(vertices) if bumpy else vertices
        near = (vertices.positions - self.origin).astype(np.float32)
        positions = self.accessor(near, "VEC3", ARRAY_BUFFER)
        limits = {"min": near.min(axis=0).tolist(), "max": near.max(axis=0).tolist()}
        self.tree["accessors"][positions] |= limits
        vertex_normal = self.accessor(vertices.normals, "VEC3", ARRAY_BUFFER)
        attributes = {"POSITION": positions, "NORMAL": vertex_normal}
        if has_uv:
            flipped = np.column_stack([vertices.uvs[:, 0], 1 - vertices.uvs[:, 1]])
            attributes["TEXCOORD_0"] = self.accessor(flipped, "VEC2", ARRAY_BUFFER)
        if bumpy:
            attributes["TANGENT"] = self.accessor(tangents(vertices), "VEC4", ARRAY_BUFFER)
        if self.colors is not None:
            linear = self.colors[vertices.sources]
            linear[:, :3] = srgb_to_linear(linear[:, :3])
            attributes["COLOR_0"] = self.accessor(linear, "VEC4", ARRAY_BUFFER)
        return {
            "attributes": attributes,
            "indices": self.accessor(vertices.faces, "SCALAR", ELEMENT_ARRAY_BUFFER),
            "material": self.material(mesh.materials[material], mesh.textures, has_uv),
        }

    def material(self, material: Material, textures: tuple[Texture, ...], has_uv: bool) -> int:
        pbr: Json = {
            "baseColorFactor": list(material.base_color),
            "metallicFactor": material.metallic,
            "roughnessFactor": material.roughness,
        }
        item: Json = {
            "name": material.name,
            "pbrMetallicRoughness": pbr,
            "emissiveFactor": list(material.emissive),
            "alphaMode": material.alpha_mode.upper(),
            "doubleSided": material.double_sided,
        }
        if material.alpha_mode == "mask":
            item["alphaCutoff"] = material.alpha_cutoff
        # A face without UV cannot look anything up: its material keeps the factors only.
        for slot, used in material.maps.items() if has_uv else ():
            known = BY_NAME[slot]
            owner = item[known.gltf_owner] if known.gltf_owner else item
            owner[known.gltf_key] = self.texture(textures, used) | _strength(known, used)
        return self.add("materials", item)

    def texture(self, textures: tuple[Texture, ...], used: TextureMap) -> Json:
        magnify, minify = FILTERS[used.filter]
        wrap_s, wrap_t = (WRAPS[wrap] for wrap in used.wrap)
        sampler = {"magFilter": magnify, "minFilter": minify, "wrapS": wrap_s, "wrapT": wrap_t}
        texture = textures[used.texture]
        item: Json = {"sampler": self.add("samplers", sampler)}
        image = self.image(used.texture, texture)
        if texture.mime == "image/webp":
            item["extensions"] = {WEBP: {"source": image}}
            self.tree["extensionsUsed"] = self.tree["extensionsRequired"] = [WEBP]
        else:
            item["source"] = image
        return {"index": self.add("textures", item)}

    def image(self, number: int, texture: Texture) -> int:
        if number not in self.images:
            image = plain_image(texture, MIMES)
            at: Json = (
                {"uri": uri(self.files[number])}
                if self.files
                else {"bufferView": self.view(image.data)}
            )
            self.images[number] = self.add(
                "images", {"name": texture.name, "mimeType": image.mime, **at}
            )
        return self.images[number]


def _strength(slot: Slot, used: TextureMap) -> Json:
    return {slot.gltf_strength: used.strength} if slot.gltf_strength and used.strength != 1 else {}


def uri(name: str) -> str:
    """A file name as a relative URI: percent-encoded, whatever a file system allows in it."""
    return quote(name, errors="surrogateescape")
