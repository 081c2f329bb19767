"""Primitives compressed with Draco: KHR_draco_mesh_compression."""

from __future__ import annotations

from importlib.util import find_spec

import numpy as np

from nispcodec.core.arrays import AnyArray, Int64Array
from nispcodec.core.extras import require
from nispcodec.io.apart import Arrays, decode_apart
from nispcodec.io.read.draco import FACES
from nispcodec.io.read.gltf_buffers import Buffers
from nispcodec.io.read.gltf_json import LARGEST, Element

EXTENSION = "KHR_draco_mesh_compression"
# Of the size of the positions: more than any quantization moves them.
_MOST_MOVED = 0.01


class DracoPrimitives:
    """The compressed primitives of a document, all decoded when the first of them is asked for.

    The attributes of the extension are the *unique ids* of Draco's attributes, which have an order
    of their own.
    """

    def __init__(self, root: Element, buffers: Buffers, warnings: list[str]) -> None:
        self._root = root
        self._buffers = buffers
        self._warnings = warnings
        self._decoded: dict[int, Arrays | str] | None = None

    def unpack(self, primitive: Element) -> Int64Array | None:
        """The corners (3 m,) of a primitive's triangles, None for one that is not compressed.

        Its attributes take the place of what the accessors have. Raises MeshError, naming the JSON
        path, for data that do not fit the document; NispError without the extra `gltf`.
        """
        compressed = primitive.extension(EXTENSION)
        if compressed is None or self._has_fallback(primitive):
            return None
        content = self._content(compressed)
        attributes = primitive.need("attributes")
        for name, unique_id in _unique_ids(compressed):
            values = content.get(str(unique_id))
            if values is None:
                compressed.fail(
                    f"an attribute of the unique id {unique_id} for {name}", _ids(content)
                )
            accessor = attributes.optional(name)
            if accessor is not None:
                self._fill(accessor, values, name)
        return self._corners(primitive, content[FACES])

    def _has_fallback(self, primitive: Element) -> bool:
        """Whether nothing here decompresses it, but the file has it uncompressed too."""
        if find_spec("DracoPy") is not None:
            return False
        positions = primitive.need("attributes").integer("POSITION")
        return self._root.entry("accessors", positions).get("bufferView") is not None

    def _content(self, compressed: Element) -> Arrays:
        view = compressed.integer("bufferView")
        if self._decoded is None:
            require("DracoPy", extra="gltf", what_for=f"{compressed.place}: reading Draco")
            self._decoded = self._decode_all()
        if view not in self._decoded:  # that of a primitive in a mesh that is malformed elsewhere
            (self._decoded[view],) = _decode([bytes(self._buffers.view(view))])
        content = self._decoded[view]
        return compressed.fail("data of Draco", content) if isinstance(content, str) else content

    def _decode_all(self) -> dict[int, Arrays | str]:
        """What the buffer views of all compressed primitives hold: one process does them all."""
        views = {
            compressed.integer("bufferView")
            for mesh in self._root.entries("meshes")
            for primitive in mesh.entries("primitives")
            if (compressed := primitive.extension(EXTENSION)) is not None
        }
        order = sorted(views)
        return dict(
            zip(order, _decode([bytes(self._buffers.view(each)) for each in order]), strict=True)
        )

    def _fill(self, accessor: int, values: AnyArray, name: str) -> None:
        stated = self._root.entry("accessors", accessor)
        if len(values) > LARGEST:
            stated.fail(f"at most {LARGEST} elements", len(values))
        if stated.integer("count") != len(values):
            self._warn(
                f"{stated.place}: says {stated.integer('count')} elements, its Draco data hold "
                f"{len(values)}"
            )
        self._buffers.fill(accessor, values)
        if name == "POSITION" and _leaves_box(stated, values):
            self._warn(f"{stated.place}: its Draco data leave the box that min and max say")

    def _corners(self, primitive: Element, faces: AnyArray) -> Int64Array:
        corners = faces.astype(np.int64).reshape(-1)
        accessor = primitive.optional("indices")
        if accessor is None:
            return corners
        stated = self._root.entry("accessors", accessor)
        triangles = primitive.integer("mode", 4) == 4
        if triangles and stated.integer("count") != len(corners):
            self._warn(
                f"{stated.place}: says {stated.integer('count')} indices, its Draco data hold "
                f"{len(corners)}"
            )
        return corners

    def _warn(self, warning: str) -> None:
        if warning not in self._warnings:
            self._warnings.append(warning)


def _decode(jobs: list[bytes]) -> list[Arrays | str]:
    return decode_apart("nispcodec.io.read.draco:decode_draco", jobs)


def _unique_ids(compressed: Element) -> list[tuple[str, int]]:
    attributes = compressed.need("attributes")
    names = attributes.value if isinstance(attributes.value, dict) else {}
    return [(name, attributes.integer(name)) for name in names]


def _ids(content: Arrays) -> list[int]:
    return sorted(int(key) for key in content if key != FACES)


def _leaves_box(stated: Element, positions: AnyArray) -> bool:
    """Whether positions (n, 3) leave the accessor's min and max by more than rounding does."""
    if stated.get("min") is None or stated.get("max") is None or not len(positions):
        return False
    low = np.array(stated.numbers("min", (0.0, 0.0, 0.0)))
    high = np.array(stated.numbers("max", (0.0, 0.0, 0.0)))
    slack = _MOST_MOVED * (high - low).max()
    return bool((positions < low - slack).any() or (positions > high + slack).any())
