"""GLB (glTF 2.0 binary): all in one file, the original image bytes embedded."""

from __future__ import annotations

import json
import struct

from nispcodec.core.arrays import Float32Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.io.write.gltf_compression import compressed
from nispcodec.io.write.gltf_tree import Json, gltf_tree


def glb_bytes(
    mesh: TexturedMesh, colors: Float32Array | None = None, compress: str | None = None
) -> bytes:
    """The mesh as the bytes of a GLB file; colors are those of `gltf_tree`.

    `compress` is one of
    `gltf_compression.COMPRESSIONS`, or None.
    """
    tree, binary = gltf_tree(mesh, colors)
    return _container(*(compressed(tree, binary, compress) if compress else (tree, binary)))


def _container(tree: Json, binary: bytes) -> bytes:
    text = json.dumps(tree, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks
