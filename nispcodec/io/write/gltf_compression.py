"""Geometry of a glTF in fewer bytes: quantized, and coded by meshoptimizer or Draco.

- quantize: positions of 16 bits, normals and tangents of 8, texture coordinates of 16 where they
  are in [0, 1] (KHR_mesh_quantization).
- meshopt: the same, coded by meshoptimizer (EXT_meshopt_compression).
- draco: positions of 15 bits, normals of 8, texture coordinates of 14 (KHR_draco_mesh_compression);
  tangents beside it, of 8 bits.

Images stay as they are. All primitives share one grid, so that they meet as before.
"""

from __future__ import annotations

import copy
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from nispcodec.core.arrays import AnyArray, Float64Array, Uint32Array
from nispcodec.io.write.tangents import tangents
from nispcodec.io.write.vertices import Vertices

Json = dict[str, Any]
Arrays = dict[str, AnyArray]

QUANTIZATION = "KHR_mesh_quantization"
MESHOPT, DRACO = "EXT_meshopt_compression", "KHR_draco_mesh_compression"
COMPRESSIONS = ("draco", "meshopt", "quantize")
BYTE, UBYTE, USHORT, UINT, FLOAT = 5120, 5121, 5123, 5125, 5126
TYPES = {USHORT: "<u2", UINT: "<u4", FLOAT: "<f4", BYTE: "<i1", UBYTE: "<u1"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
DRACO_BITS = {"quantization_bits": 15, "normal_quantization_bits": 8}
DRACO_UV_BITS = 14
# Draco's own numbers of what an attribute is.
DRACO_KINDS = {0: "POSITION", 1: "NORMAL", 2: "COLOR_0", 3: "TEXCOORD_0"}
HIGHEST = 2**16 - 1


def compressed(tree: Json, binary: bytes, how: str) -> tuple[Json, bytes]:
    """JSON and buffer of a glTF of float32 attributes and one node, as one of `COMPRESSIONS`."""
    return _Packer(copy.deepcopy(tree), tree, binary, how).run()


@dataclass
class _Packer:
    """A tree that is rewritten, with a buffer of its own, from one that stays."""

    tree: Json
    source: Json
    binary: bytes
    how: str
    buffer: bytearray = field(default_factory=bytearray)
    fallback: int = 0
    quantized: bool = False

    def run(self) -> tuple[Json, bytes]:
        self.tree["bufferViews"], self.tree["accessors"] = [], []
        primitives = self.tree["meshes"][0]["primitives"]
        places = [self.array(each["attributes"]["POSITION"]) for each in primitives]
        every = np.concatenate(places).astype(np.float64)
        grid = _Grid(every.min(axis=0), float(np.ptp(every, axis=0).max()) or 1.0)
        for primitive in primitives:
            self.primitive(primitive, grid)
        for image in self.tree.get("images", ()):
            if "bufferView" in image:
                image["bufferView"] = self.view(self.bytes_of(image["bufferView"]))
        if self.how != "draco":
            grid.place(self.tree["nodes"][0])
        draco = [DRACO, QUANTIZATION] if self.quantized else [DRACO]
        self.declare({"draco": draco, "meshopt": [QUANTIZATION, MESHOPT]})
        self.buffer += bytes(-len(self.buffer) % 4)
        self.tree["buffers"] = [{"byteLength": len(self.buffer)}]
        if self.fallback:
            extensions = {MESHOPT: {"fallback": True}}
            self.tree["buffers"].append({"byteLength": self.fallback, "extensions": extensions})
        return self.tree, bytes(self.buffer)

    def declare(self, named: dict[str, list[str]]) -> None:
        for key in ("extensionsUsed", "extensionsRequired"):
            known = self.source.get(key, [])
            self.tree[key] = [*known, *named.get(self.how, [QUANTIZATION])]

    def bytes_of(self, view: int) -> bytes:
        found = self.source["bufferViews"][view]
        return self.binary[found["byteOffset"] : found["byteOffset"] + found["byteLength"]]

    def array(self, accessor: int) -> AnyArray:
        found = self.source["accessors"][accessor]
        values = np.frombuffer(self.bytes_of(found["bufferView"]), TYPES[found["componentType"]])
        width = WIDTHS[found["type"]]
        return values if width == 1 else values.reshape(-1, width)

    def primitive(self, primitive: Json, grid: _Grid) -> None:
        names = primitive["attributes"]
        arrays = {name: self.array(accessor) for name, accessor in names.items()}
        indices = self.array(primitive["indices"]).astype(np.uint32)
        if self.how == "draco":
            self.draco(primitive, arrays, indices, grid)
            return
        if self.how == "meshopt":
            arrays, indices = _in_order(arrays, indices)
        for name, values in arrays.items():
            names[name] = self.attribute(name, grid.quantized(name, values))
        primitive["indices"] = self.indices(indices, len(arrays["POSITION"]))

    def attribute(self, name: str, values: AnyArray) -> int:
        """Rows of a multiple of four bytes, as vertex attributes are to have."""
        count, width = values.shape
        spare = -width * values.itemsize % 4 // values.itemsize
        rows = np.ascontiguousarray(np.pad(values, ((0, 0), (0, spare))))
        stride = rows.shape[1] * rows.itemsize
        view = self.coded("ATTRIBUTES", rows.tobytes(), count, stride, lambda: _vertices(rows))
        self.tree["bufferViews"][view] |= {"byteStride": stride, "target": 34962}
        return self.accessor(name, values, view)

    def indices(self, indices: Uint32Array, vertices: int) -> int:
        short = vertices <= HIGHEST
        values = indices.astype("<u2" if short else "<u4")
        made = values.tobytes()
        view = self.coded(
            "TRIANGLES", made, len(values), values.itemsize, lambda: _triangles(indices)
        )
        self.tree["bufferViews"][view]["target"] = 34963
        kind = USHORT if short else UINT
        return self.add("accessors", _stated(len(values), "SCALAR", kind) | {"bufferView": view})

    def coded(
        self, mode: str, raw: bytes, count: int, stride: int, encode: Callable[[], bytes]
    ) -> int:
        """A view of raw bytes, or of what decoders make of coded ones."""
        if self.how != "meshopt":
            return self.view(raw)
        made = self.view(encode())
        stored = self.tree["bufferViews"].pop()
        how = {**stored, "byteStride": stride, "mode": mode, "count": count}
        self.tree["bufferViews"].append(
            {
                "buffer": 1,
                "byteOffset": self.fallback,
                "byteLength": len(raw),
                "extensions": {MESHOPT: how},
            }
        )
        self.fallback += len(raw) + -len(raw) % 4
        return made

    def draco(self, primitive: Json, arrays: Arrays, indices: Uint32Array, grid: _Grid) -> None:
        data = _draco(arrays, indices, grid)
        ids, content, faces = _undone(data)
        names = primitive["attributes"]
        if "TANGENT" in names:
            self.tangents(names, content, faces)
        for name, values in content.items():
            names[name] = self.accessor(name, values, None)
        primitive["indices"] = self.add("accessors", _stated(faces.size, "SCALAR", UINT))
        stored = {"bufferView": self.view(data), "attributes": ids}
        primitive["extensions"] = {DRACO: stored}

    def tangents(self, names: Json, content: Arrays, faces: AnyArray) -> None:
        """Those of the vertices that a decoder finds, beside what Draco holds.

        Draco knows no tangents, and as any attribute they would take 16 bytes each.
        """
        uvs = content["TEXCOORD_0"] * np.array([1, -1], np.float32) + np.array([0, 1], np.float32)
        vertices = Vertices(
            positions=content["POSITION"].astype(np.float64),
            uvs=uvs,
            normals=content["NORMAL"],
            faces=faces.astype(np.uint32),
            sources=np.arange(len(uvs)),
        )
        rounded = np.rint(tangents(vertices) * 127).astype("<i1")
        names["TANGENT"] = self.attribute("TANGENT", rounded)
        self.quantized = True

    def accessor(self, name: str, values: AnyArray, view: int | None) -> int:
        kind = next(each for each, code in TYPES.items() if np.dtype(code) == values.dtype)
        item = _stated(len(values), f"VEC{values.shape[1]}", kind)
        if view is not None:
            item["bufferView"] = view
        if kind != FLOAT and name != "POSITION":
            item["normalized"] = True
        if name == "POSITION":
            item |= {"min": values.min(axis=0).tolist(), "max": values.max(axis=0).tolist()}
        return self.add("accessors", item)

    def view(self, data: bytes) -> int:
        self.buffer += bytes(-len(self.buffer) % 4)
        item = {"buffer": 0, "byteOffset": len(self.buffer), "byteLength": len(data)}
        self.buffer += data
        return self.add("bufferViews", item)

    def add(self, kind: str, item: Json) -> int:
        self.tree[kind].append(item)
        return len(self.tree[kind]) - 1


@dataclass(frozen=True)
class _Grid:
    """The cube of positions: its low corner (3,) and its size."""

    low: Float64Array
    size: float

    def quantized(self, name: str, values: AnyArray) -> AnyArray:
        if name == "POSITION":
            return np.rint((values - self.low) * (HIGHEST / self.size)).astype("<u2")
        if name in ("NORMAL", "TANGENT"):
            return np.rint(values * 127).astype("<i1")
        if values.min(initial=0) < 0 or values.max(initial=0) > 1:
            return values.astype("<f4")
        return np.rint(values * HIGHEST).astype("<u2")

    def place(self, node: Json) -> None:
        """The node that puts whole numbers where positions were."""
        shift = np.asarray(node.get("translation", (0.0, 0.0, 0.0))) + self.low
        node["translation"] = shift.tolist()
        node["scale"] = [self.size / HIGHEST] * 3


def _stated(count: int, kind: str, component: int) -> Json:
    return {"componentType": component, "count": count, "type": kind}


def _in_order(arrays: Arrays, indices: Uint32Array) -> tuple[Arrays, Uint32Array]:
    """Triangles as caches of vertices like them, and vertices as triangles first use them."""
    import meshoptimizer

    ordered = np.empty_like(indices)
    meshoptimizer.optimize_vertex_cache(ordered, indices, vertex_count=len(arrays["POSITION"]))
    used, first, inverse = np.unique(ordered, return_index=True, return_inverse=True)
    order = np.argsort(first, kind="stable")
    places = np.empty(len(order), np.uint32)
    places[order] = np.arange(len(order), dtype=np.uint32)
    return {name: values[used[order]] for name, values in arrays.items()}, places[inverse]


def _vertices(rows: AnyArray) -> bytes:
    import meshoptimizer

    # The version that EXT_meshopt_compression has.
    meshoptimizer.encode_vertex_version(0)
    return meshoptimizer.encode_vertex_buffer(rows)


def _triangles(indices: Uint32Array) -> bytes:
    import meshoptimizer

    meshoptimizer.encode_index_version(1)
    return meshoptimizer.encode_index_buffer(indices)


def _draco(arrays: Arrays, indices: Uint32Array, grid: _Grid) -> bytes:
    import DracoPy

    colors = arrays.get("COLOR_0")
    return DracoPy.encode(
        arrays["POSITION"],
        indices.reshape(-1, 3),
        quantization_range=grid.size,
        quantization_origin=grid.low,
        compression_level=7,
        normals=_doubles(arrays.get("NORMAL")),
        tex_coord=_doubles(arrays.get("TEXCOORD_0")),
        tex_coord_quantization_bits=DRACO_UV_BITS if "TEXCOORD_0" in arrays else None,
        colors=None if colors is None else np.rint(colors * 255).astype(np.uint8),
        **DRACO_BITS,
    )


def _undone(data: bytes) -> tuple[dict[str, int], Arrays, AnyArray]:
    """The unique id of each attribute, its values, and the faces (m, 3).

    Draco joins vertices that rounding made equal: accessors state what a decoder finds.
    """
    import DracoPy

    mesh = DracoPy.decode(data)
    named = {DRACO_KINDS[each["attribute_type"]]: each for each in mesh.attributes}
    ids = {name: each["unique_id"] for name, each in named.items()}
    return ids, {name: np.asarray(each["data"]) for name, each in named.items()}, mesh.faces


def _doubles(values: AnyArray | None) -> AnyArray | None:
    """What DracoPy takes, though it writes singles."""
    return None if values is None else values.astype(np.float64)
