"""Binary glTF with positions and UVs as floats: what most tools load without asking."""

from __future__ import annotations

import json
import struct
from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks.assets.corners import corners_of
from benchmarks.assets.source import Source
from benchmarks.codecs import Setting
from nispcodec.core.arrays import AnyArray
from nispcodec.core.asset import TexturedMesh
from nispcodec.io.folder import Folder
from nispcodec.io.read.gltf import read_gltf

ARRAYS, INDICES = 34962, 34963
TYPES = {"<f4": 5126, "<u4": 5125, "<u2": 5123}
# A material with an image, the smallest there is: gltfpack drops UVs that no image uses.
PIXEL = (
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNoAAAAggCBd81ytgAA"
    "AABJRU5ErkJggg=="
)


def settings(source: Source, quick: bool) -> list[Setting]:
    """There is one."""
    return [{}]


def encode(source: Source, setting: Setting) -> bytes:
    """One primitive a material, indices as small as they can be."""
    corners = corners_of(source.mesh)
    tree: dict[str, Any] = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}]}
    tree |= {"nodes": [{"mesh": 0}], "bufferViews": [], "accessors": [], "materials": []}
    tree |= {"images": [{"uri": PIXEL}], "textures": [{"source": 0}]}
    blob, primitives = bytearray(), []
    for material, described in enumerate(source.mesh.materials):
        part = corners.only(corners.faces[corners.materials[corners.faces[:, 0]] == material])
        pixel = {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}
        tree["materials"].append({"name": described.name, **pixel})
        if not len(part.faces):
            continue
        uvs = np.column_stack([part.uvs[:, 0], 1 - part.uvs[:, 1]])
        position = _accessor(tree, blob, part.positions.astype("<f4"), ARRAYS)
        texcoord = _accessor(tree, blob, uvs.astype("<f4"), ARRAYS)
        kind = "<u2" if len(part.positions) < 2**16 - 1 else "<u4"
        indices = _accessor(tree, blob, part.faces.ravel().astype(kind), INDICES)
        attributes = {"POSITION": position, "TEXCOORD_0": texcoord}
        primitives.append({"attributes": attributes, "indices": indices, "material": material})
    tree |= {"meshes": [{"primitives": primitives}], "buffers": [{"byteLength": len(blob)}]}
    return _container(tree, bytes(blob))


def decode(data: bytes, source: Source) -> TexturedMesh:
    """Our own reader; materials are told by their names."""
    return with_materials(read_gltf(data, "decoded.glb", Folder(source.path.parent)), source)


def with_materials(mesh: TexturedMesh, source: Source) -> TexturedMesh:
    """A mesh that was read back, with the source's materials in the place of those it names."""
    names = [material.name for material in source.mesh.materials]
    order = np.array([names.index(material.name) for material in mesh.materials], dtype=np.int32)
    return replace(
        mesh,
        materials=source.mesh.materials,
        textures=source.mesh.textures,
        face_materials=order[mesh.face_materials],
    )


def _accessor(tree: dict[str, Any], blob: bytearray, array: AnyArray, target: int) -> int:
    blob += b"\0" * (-len(blob) % 4)
    view = {"buffer": 0, "byteOffset": len(blob), "byteLength": array.nbytes, "target": target}
    tree["bufferViews"].append(view)
    blob += array.tobytes()
    accessor: dict[str, Any] = {
        "bufferView": len(tree["bufferViews"]) - 1,
        "componentType": TYPES[array.dtype.str],
        "count": len(array),
        "type": "SCALAR" if array.ndim == 1 else f"VEC{array.shape[1]}",
    }
    if array.ndim > 1:
        accessor |= {"min": array.min(axis=0).tolist(), "max": array.max(axis=0).tolist()}
    tree["accessors"].append(accessor)
    return len(tree["accessors"]) - 1


def _container(tree: dict[str, Any], blob: bytes) -> bytes:
    text = json.dumps(tree, separators=(",", ":")).encode()
    text, blob = text + b" " * (-len(text) % 4), blob + b"\0" * (-len(blob) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(blob), b"BIN\0") + blob
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks
