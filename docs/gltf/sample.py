"""Writes `sample.glb`, an octahedron as triangles, with the same as a `.nisp` inside.

`python docs/gltf/sample.py`. The signed distance (|x| + |y| + |z| - 1) / sqrt(3) is a network of
one rectified neuron, as `mirror` gives it the absolute values of the coordinates.
"""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np

from nispcodec import TexturedMesh
from nispcodec.core.asset import Material
from nispcodec.core.document import ChartTable, Document, Field, Frame
from nispcodec.core.network import Network, NetworkSpec
from nispcodec.format import pack
from nispcodec.io.write.glb import glb_bytes

TARGET = Path(__file__).with_name("sample.glb")
EXTENSION = "NISP_neural_mesh"
MATERIAL = Material("gem", (0.1, 0.4, 0.8, 1.0), roughness=0.5)


def octahedron() -> TexturedMesh:
    """The triangles, outwards."""
    corners = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)
    signs = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    faces = [(x, 2 + y, 4 + z) if (x + y + z) % 2 == 0 else (2 + y, x, 4 + z) for x, y, z in signs]
    return TexturedMesh(
        positions=corners,
        faces=np.array(faces, np.int32),
        uvs=np.zeros((0, 2)),
        uv_faces=np.full((8, 3), -1, np.int32),
        face_materials=np.zeros(8, np.int32),
        materials=(MATERIAL,),
        textures=(),
    )


def document() -> Document:
    """The same surface as a network."""
    slope = float(np.float32(3**-0.5))
    tensors = {
        "weight.0": np.full((1, 3), slope, np.float32),
        "bias.0": np.zeros(1, np.float32),
        "weight.1": np.ones((1, 1), np.float32),
        "bias.1": np.full(1, -slope, np.float32),
    }
    return Document(
        frame=Frame((0.0, 0.0, 0.0), 1.0),
        materials=(MATERIAL,),
        textures=(),
        field=Field(
            charts=ChartTable(np.zeros(1, np.int32), np.zeros(1, np.bool_)),
            sdf=Network(NetworkSpec((1,), 1, activation="relu", mirror=7), tensors),
        ),
    )


def with_extension(glb: bytes, nisp: bytes) -> bytes:
    """A GLB of one mesh with a `.nisp` in a buffer view of its own."""
    tree, binary = parts(glb)
    binary += bytes(-len(binary) % 4)
    view = {"buffer": 0, "byteOffset": len(binary), "byteLength": len(nisp)}
    tree["bufferViews"].append(view)
    binary += nisp
    tree["buffers"][0]["byteLength"] = len(binary)
    number = len(tree["bufferViews"]) - 1
    tree["meshes"][0]["extensions"] = {EXTENSION: {"bufferView": number, "materials": [0]}}
    tree["extensionsUsed"] = [*tree.get("extensionsUsed", []), EXTENSION]
    chunks = [
        (b"JSON", json.dumps(tree, separators=(",", ":")).encode(), b" "),
        (b"BIN\0", binary, b"\0"),
    ]
    padded = [(kind, data + fill * (-len(data) % 4)) for kind, data, fill in chunks]
    body = b"".join(struct.pack("<I4s", len(data), kind) + data for kind, data in padded)
    return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body


def parts(glb: bytes) -> tuple[dict[str, Any], bytes]:
    """The JSON of a GLB and its binary buffer, padding left out."""
    length = struct.unpack_from("<I", glb, 12)[0]
    tree = json.loads(glb[20 : 20 + length])
    start = 28 + length
    return tree, glb[start : start + tree["buffers"][0]["byteLength"]]


def sample() -> bytes:
    """The bytes of `sample.glb`."""
    return with_extension(glb_bytes(octahedron()), pack(document()))


if __name__ == "__main__":
    TARGET.write_bytes(sample())
