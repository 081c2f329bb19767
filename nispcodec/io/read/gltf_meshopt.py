"""Buffer views compressed with meshoptimizer: EXT_ and KHR_meshopt_compression.

The decoder checks the bytes that it reads. What it is told of their size is checked here.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from nispcodec.core.extras import require
from nispcodec.io.read.gltf_json import LARGEST, Element

if TYPE_CHECKING:
    from nispcodec.core.arrays import Uint8Array, Uint32Array

EXTENSIONS = ("EXT_meshopt_compression", "KHR_meshopt_compression")
# The sizes in bytes that an element may have, by mode and by filter.
_STRIDES = {
    "ATTRIBUTES": range(4, 257, 4),
    "TRIANGLES": (2, 4),
    "INDICES": (2, 4),
    "NONE": range(2, 257),
    "OCTAHEDRAL": (4, 8),
    "QUATERNION": (8,),
    "EXPONENTIAL": range(4, 257, 4),
}
_FILTERS = ("NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL")
# Elements that one byte can stand for: vertices come in blocks of up to 256, each with a header.
_MOST_PER_BYTE = {"ATTRIBUTES": 256, "TRIANGLES": 3, "INDICES": 1}


def compression(view: Element) -> Element | None:
    """The object that says how a buffer view is compressed, None for one that is not."""
    found = (view.extension(name) for name in EXTENSIONS)
    return next((each for each in found if each is not None), None)


def decompress(compressed: Element, data: memoryview, expected: int) -> bytes:
    """The bytes of a buffer view, `expected` in number, from compressed `data`.

    Raises MeshError, naming the JSON path, for what is malformed or cut short; NispError without
    the extra `gltf`.
    """
    require("meshoptimizer", extra="gltf", what_for=f"{compressed.place}: reading meshopt")
    count, stride = compressed.integer("count"), compressed.integer("byteStride")
    mode, chosen = compressed.text("mode", ""), compressed.text("filter", "NONE")
    _expect_known(compressed, mode, chosen, stride)
    _expect_possible(compressed, mode, count, len(data))
    if count * stride != expected:
        compressed.fail(f"count times byteStride to be {expected}", count * stride)
    try:
        raw = _DECODERS[mode](count, stride, data)
    except (ValueError, RuntimeError) as why:
        compressed.fail("data of meshoptimizer", str(why))
    return _FILTER_CALLS[chosen](raw, count, stride).tobytes()


def _expect_known(compressed: Element, mode: str, chosen: str, stride: int) -> None:
    if mode not in _MOST_PER_BYTE:
        compressed.fail(f"a mode of {', '.join(_MOST_PER_BYTE)}", mode)
    if chosen not in _FILTERS or (mode != "ATTRIBUTES" and chosen != "NONE"):
        compressed.fail(f"a filter of {', '.join(_FILTERS)}, and NONE for indices", chosen)
    if stride not in _STRIDES[mode] or stride not in _STRIDES[chosen]:
        compressed.fail(f"a byteStride for {mode} and {chosen}", stride)


def _expect_possible(compressed: Element, mode: str, count: int, length: int) -> None:
    """A count costs a file nothing, and memory much."""
    most = min(LARGEST * 3, _MOST_PER_BYTE[mode] * length)
    if count > most:
        compressed.fail(f"at most {most} elements in {length} bytes", count)
    if mode == "TRIANGLES" and count % 3:
        compressed.fail("a multiple of 3 indices", count)


def _vertices(count: int, stride: int, data: memoryview) -> Uint8Array:
    import meshoptimizer

    if not count:
        return np.zeros(0, np.uint8)
    return meshoptimizer.decode_vertex_buffer(count, stride, data).view(np.uint8).reshape(-1)


def _triangles(count: int, stride: int, data: memoryview) -> Uint8Array:
    import meshoptimizer

    # The package decodes into 32 bits, whatever it is told.
    return _narrowed(meshoptimizer.decode_index_buffer(count, 4, data), stride)


def _sequence(count: int, stride: int, data: memoryview) -> Uint8Array:
    import meshoptimizer

    return _narrowed(meshoptimizer.decode_index_sequence(count, 4, data), stride)


def _narrowed(indices: Uint32Array, stride: int) -> Uint8Array:
    """The bytes of indices of `stride` bytes each."""
    if stride == 2 and indices.size and indices.max() > 0xFFFF:
        raise ValueError("an index over 65535 in 2 bytes")
    return indices.astype("<u2" if stride == 2 else "<u4").view(np.uint8)


def _octahedral(raw: Uint8Array, count: int, stride: int) -> Uint8Array:
    import meshoptimizer

    return meshoptimizer.decode_filter_oct(raw, count, stride)


def _quaternion(raw: Uint8Array, count: int, stride: int) -> Uint8Array:
    import meshoptimizer

    return meshoptimizer.decode_filter_quat(raw, count, stride)


def _exponential(raw: Uint8Array, count: int, stride: int) -> Uint8Array:
    import meshoptimizer

    return meshoptimizer.decode_filter_exp(raw, count, stride)


_DECODERS: dict[str, Callable[[int, int, memoryview], Uint8Array]] = {
    "ATTRIBUTES": _vertices,
    "TRIANGLES": _triangles,
    "INDICES": _sequence,
}
_FILTER_CALLS: dict[str, Callable[[Uint8Array, int, int], Uint8Array]] = {
    "NONE": lambda raw, _, __: raw,
    "OCTAHEDRAL": _octahedral,
    "QUATERNION": _quaternion,
    "EXPONENTIAL": _exponential,
}
