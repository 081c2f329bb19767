"""The binary side of glTF 2.0: containers, buffers, accessors; every range is checked first."""

from __future__ import annotations

import base64
import struct
from importlib.util import find_spec
from typing import Any
from urllib.parse import unquote, unquote_to_bytes

import numpy as np

from nispcodec.core.arrays import AnyArray, Float64Array, Int64Array
from nispcodec.core.errors import MeshError
from nispcodec.io.folder import Folder
from nispcodec.io.read.coordinates import without_unused
from nispcodec.io.read.gltf_json import Element
from nispcodec.io.read.gltf_meshopt import compression, decompress

_COMPONENTS: dict[int, np.dtype[Any]] = {
    5120: np.dtype("i1"),
    5121: np.dtype("u1"),
    5122: np.dtype("<i2"),
    5123: np.dtype("<u2"),
    5125: np.dtype("<u4"),
    5126: np.dtype("<f4"),
}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
_JSON_CHUNK, _BINARY_CHUNK = 0x4E4F534A, 0x004E4942
# An accessor without a buffer view is all zeros and costs a file nothing: no more than this.
_MOST_ZEROS = 10_000_000


def split_glb(data: bytes, name: str, warnings: list[str]) -> tuple[bytes, bytes | None]:
    """The JSON text and the binary chunk, if any, of a GLB file; other data is JSON text itself.

    What does not fit the container but can be read past is said in new `warnings`. Raises
    MeshError, naming the file `name`, for a container that is malformed otherwise.
    """
    if not data.startswith(b"glTF"):
        return data, None
    if len(data) < 12:
        raise MeshError(f"{name}: expected a GLB header of 12 bytes, found {len(data)}")
    version, length = struct.unpack_from("<II", data, 4)
    if version != 2:
        raise MeshError(f"{name}: expected GLB version 2, found {version}")
    chunks, end = _chunks(data, name)
    # Those who stream do not know it when they write it.
    if length and not end <= length <= len(data):
        warnings.append(f"{name}: expected {length} bytes as in the header, found {len(data)}")
    if end < len(data):
        warnings.append(f"{name}: left out {len(data) - end} bytes after the last chunk")
    if not chunks or chunks[0][0] != _JSON_CHUNK:
        found = f"chunk type {chunks[0][0]:#x}" if chunks else "no chunk"
        raise MeshError(f"{name}: expected a JSON chunk first, found {found}")
    binary = next((chunk for kind, chunk in chunks if kind == _BINARY_CHUNK), None)
    return chunks[0][1].rstrip(b"\0"), binary  # with which some pad it, in place of spaces


def _chunks(data: bytes, name: str) -> tuple[list[tuple[int, bytes]], int]:
    """The kind and bytes of each chunk, and where the last one ends."""
    chunks, at = list[tuple[int, bytes]](), 12
    while at + 8 <= len(data):
        length, kind = struct.unpack_from("<II", data, at)
        left = len(data) - at - 8
        if kind == _BINARY_CHUNK and length == 0:
            length = left  # streamed: nothing but padding may follow
        if length > left:
            if chunks and kind != _BINARY_CHUNK:
                break  # no chunk, but what someone has appended
            raise MeshError(
                f"{name}: byte {at + 8}: expected a chunk of {length} bytes, found {left}: "
                f"file cut short"
            )
        chunks.append((kind, data[at + 8 : at + 8 + length]))
        at += 8 + length
    return chunks, at


def read_uri(uri: str, folder: Folder, place: str) -> bytes | None:
    """The bytes behind a data URI or a file name; None when there is no such file.

    Raises MeshError, naming `place`, for a file that cannot be read and for malformed base64.
    """
    if not uri.startswith("data:"):
        # What is no UTF-8 names a file byte for byte.
        path = folder.find(unquote(uri, errors="surrogateescape")) or folder.find(uri)
        return None if path is None else folder.read(path)
    header, _, payload = uri.partition(",")
    if not header.endswith(";base64"):
        return unquote_to_bytes(payload)
    try:
        return base64.b64decode(payload)
    except ValueError as why:
        raise MeshError(f"{place}: expected base64 in the data URI, found: {why}") from why


class Buffers:
    """The buffers of one glTF document, read when first used.

    Raises MeshError, naming the JSON path, in every method that finds the document malformed.
    """

    def __init__(self, root: Element, binary: bytes | None, folder: Folder) -> None:
        self._root = root
        self._binary = binary
        self._folder = folder
        self._read: dict[int, bytes] = {}
        self._decompressed: dict[int, bytes] = {}
        self._filled: dict[int, AnyArray] = {}

    def fill(self, index: int, values: AnyArray) -> None:
        """Let accessor `index` have values (n, width) that the file holds in another way."""
        known = self._filled.setdefault(index, values)
        if known is not values and not np.array_equal(known, values):
            self._root.entry("accessors", index).fail(
                "the same values by all that use it", "others"
            )

    def view(self, index: int) -> memoryview:
        """The bytes of buffer view `index`, decompressed."""
        view = self._root.entry("bufferViews", index)
        compressed = compression(view)
        if compressed is None or self._has_fallback(view):
            return self._stored(view)
        if index not in self._decompressed:
            length = view.integer("byteLength")
            self._decompressed[index] = decompress(compressed, self._stored(compressed), length)
        return memoryview(self._decompressed[index])

    def _stored(self, part: Element) -> memoryview:
        """The bytes that `part` names by its buffer, byteOffset and byteLength."""
        offset, length = part.integer("byteOffset", 0), part.integer("byteLength")
        buffer = self._buffer(part.integer("buffer"))
        if offset + length > len(buffer):
            part.fail(f"an end within {len(buffer)} bytes", offset + length)
        return memoryview(buffer)[offset : offset + length]

    def _has_fallback(self, view: Element) -> bool:
        """Whether nothing here decompresses the view, but the file has it uncompressed too."""
        if find_spec("meshoptimizer") is not None:
            return False
        buffer = self._root.entry("buffers", view.integer("buffer"))
        return buffer.get("uri") is not None or compression(buffer) is None

    def numbers(self, index: int, width: int, finite: bool = True) -> Float64Array:
        """Accessor `index` as numbers (n, width) float64, which must be `finite` or need not.

        Normalized integers become fractions (glTF 2.0, 3.6.2.2).
        """
        accessor = self._root.entry("accessors", index)
        values = self._values(index, accessor, width)
        if finite:
            _expect_finite(accessor, values)
        with np.errstate(invalid="ignore"):  # signaling NaN
            numbers = values.astype(np.float64)
        if accessor.flag("normalized") and values.dtype.kind in "iu":
            numbers = np.maximum(numbers / np.iinfo(values.dtype).max, -1.0)
        return numbers

    def count(self, index: int, width: int) -> int:
        """How many elements of so many numbers accessor `index` has."""
        return len(self._values(index, self._root.entry("accessors", index), width))

    def used_numbers(self, index: int, corners: Int64Array, warnings: list[str]) -> Float64Array:
        """Accessor `index` as (n, 3) finite numbers; 0 where only rows without `corners` are not.

        These are said in new `warnings`.
        """
        accessor = self._root.entry("accessors", index)
        rows = self.numbers(index, 3, finite=False)
        rows = without_unused(rows, corners, accessor.place, warnings)
        _expect_finite(accessor, rows)
        return rows

    def indices(self, index: int) -> Int64Array:
        """Accessor `index`, which holds unsigned integers, as (n,) int64."""
        return self.integers(index, 1)[:, 0]

    def integers(self, index: int, width: int) -> Int64Array:
        """Accessor `index`, which holds unsigned integers, as (n, width) int64."""
        accessor = self._root.entry("accessors", index)
        values = self._values(index, accessor, width)
        if values.dtype.kind != "u":
            accessor.fail("unsigned integers", values.dtype.name)
        return values.astype(np.int64)

    def _buffer(self, index: int) -> bytes:
        if index not in self._read:
            self._read[index] = self._open(index)
        return self._read[index]

    def _open(self, index: int) -> bytes:
        buffer = self._root.entry("buffers", index)
        length = buffer.integer("byteLength")
        if buffer.get("uri") is None:
            data = self._binary if index == 0 else None
        else:
            data = read_uri(buffer.text("uri", ""), self._folder, buffer.place)
        if data is None:
            buffer.fail("a binary file", buffer.text("uri", "no binary chunk"))
        if len(data) < length:
            buffer.fail(f"{length} bytes", f"{len(data)} bytes")
        return data[:length]

    def _values(self, index: int, accessor: Element, width: int) -> AnyArray:
        kind = accessor.text("type", "")
        if _WIDTHS.get(kind) != width:
            accessor.fail(f"type {next(k for k, w in _WIDTHS.items() if w == width)}", kind)
        if index in self._filled:
            return _as_stated(accessor, self._filled[index], width)
        count = accessor.integer("count")
        if accessor.get("bufferView") is None:
            if count > _MOST_ZEROS:
                accessor.fail(f"at most {_MOST_ZEROS} elements without a bufferView", count)
            values: Float64Array = np.zeros((count, width), dtype=_component(accessor))
        else:
            values = self._elements(accessor, count, _component(accessor), width)
        sparse = accessor.get("sparse")
        return values if sparse is None else self._with_sparse(values, sparse)

    def _elements(self, reader: Element, count: int, dtype: np.dtype[Any], width: int) -> AnyArray:
        """(count, width) view of the bufferView that `reader` names, at its byteOffset."""
        index = reader.integer("bufferView")
        data, offset = self.view(index), reader.integer("byteOffset", 0)
        size = dtype.itemsize * width
        stride = self._root.entry("bufferViews", index).integer("byteStride", 0) or size
        end = offset + stride * (count - 1) + size
        if count and end > len(data):
            reader.fail(f"an end within the {len(data)} bytes of bufferView {index}", end)
        if not count:
            return np.zeros((0, width), dtype=dtype)
        return np.ndarray((count, width), dtype, data, offset, (stride, dtype.itemsize))

    def _with_sparse(self, base: AnyArray, sparse: Element) -> AnyArray:
        count = sparse.integer("count")
        indices, values = sparse.need("indices"), sparse.need("values")
        places = self._elements(indices, count, _component(indices), 1)[:, 0]
        if places.dtype.kind != "u" or (count and int(places.max()) >= len(base)):
            indices.fail(f"unsigned indices below {len(base)}", places.tolist())
        filled = base.copy()
        filled[places] = self._elements(values, count, base.dtype, base.shape[1])
        return filled


def _expect_finite(accessor: Element, values: AnyArray) -> None:
    usable = np.isfinite(values).all(axis=1)
    if not usable.all():
        element = int(usable.argmin())
        accessor.fail(f"finite numbers in element {element}", values[element].tolist())


def _as_stated(accessor: Element, values: AnyArray, width: int) -> AnyArray:
    """Values (n, width) in the type of number that the accessor says, which must hold them."""
    if values.ndim != 2 or values.shape[1] != width:
        accessor.fail(f"{width} numbers in each element", values.shape[1:])
    with np.errstate(invalid="ignore"):
        stated = values.astype(_component(accessor))
    if not np.array_equal(stated, values, equal_nan=True):
        accessor.fail(f"numbers that fit {stated.dtype.name}", values.dtype.name)
    return stated


def _component(element: Element) -> np.dtype[Any]:
    code = element.integer("componentType")
    if code not in _COMPONENTS:
        element.fail(f"a componentType of {list(_COMPONENTS)}", code)
    return _COMPONENTS[code]
