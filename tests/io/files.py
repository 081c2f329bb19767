"""Small files to read: images, OBJ folders, glTF documents."""

from __future__ import annotations

import base64
import io
import json
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import PIL.Image

from nispcodec.core.asset import TexturedMesh
from nispcodec.core.errors import MeshError
from nispcodec.io.load import load_mesh

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"

_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}


def image(format: str = "PNG", color: tuple[int, int, int] = (200, 30, 30), size: int = 4) -> bytes:
    buffer = io.BytesIO()
    PIL.Image.new("RGB", (size, size), color).save(buffer, format)
    return buffer.getvalue()


def load_obj(folder: Path, text: str | bytes, **files: str | bytes) -> TexturedMesh:
    """Write a.obj and its companions (`a_mtl` is a.mtl) and load it."""
    data = text.encode() if isinstance(text, str) else text
    (folder / "a.obj").write_bytes(data)
    for name, content in files.items():
        stem, _, suffix = name.rpartition("_")
        raw = content.encode() if isinstance(content, str) else content
        (folder / f"{stem}.{suffix}").write_bytes(raw)
    return load_mesh(folder / "a.obj")


def outcome(call: Callable[..., Any], *arguments: Any) -> Any:
    """What the call returns, or the MeshError that it raises."""
    try:
        return call(*arguments)
    except MeshError as error:
        return error


class Gltf:
    """Builds a glTF document with one binary buffer."""

    def __init__(self) -> None:
        self.data = b""
        self.other_buffers: list[dict[str, Any]] = []
        self.json: dict[str, Any] = {
            "asset": {"version": "2.0"},
            "bufferViews": [],
            "accessors": [],
        }

    def view(self, data: bytes, **more: Any) -> int:
        self.data += b"\0" * (-len(self.data) % 4)
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data), **more}
        self.data += data
        self.json["bufferViews"].append(view)
        return len(self.json["bufferViews"]) - 1

    def accessor(self, values: Any, dtype: str = "<f4", **more: Any) -> int:
        array = np.asarray(values, dtype=dtype)
        codes = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}
        accessor = {
            "bufferView": self.view(array.tobytes()),
            "componentType": codes[dtype[-2:]],
            "count": len(array),
            "type": _TYPES[array.shape[1] if array.ndim > 1 else 1],
            **more,
        }
        self.json["accessors"].append(accessor)
        return len(self.json["accessors"]) - 1

    def scene(self, primitives: list[dict[str, Any]], **node: Any) -> Gltf:
        """One node that shows one mesh."""
        self.json["meshes"] = [{"primitives": primitives}]
        self.json["nodes"] = [{"mesh": 0, **node}]
        self.json["scenes"] = [{"nodes": [0]}]
        return self

    def glb(self) -> bytes:
        self.json["buffers"] = [{"byteLength": len(self.data)}, *self.other_buffers]
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        binary = self.data + b"\0" * (-len(self.data) % 4)
        chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
        chunks += struct.pack("<II", len(binary), 0x004E4942) + binary
        return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks

    def text(self) -> bytes:
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
        self.json["buffers"] = [{"byteLength": len(self.data), "uri": uri}]
        return json.dumps(self.json).encode()

    def load(self, folder: Path) -> TexturedMesh:
        (folder / "a.glb").write_bytes(self.glb())
        return load_mesh(folder / "a.glb")
