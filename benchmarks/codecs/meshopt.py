"""meshoptimizer's codec: rounded vertices and indices, each in a Zstandard frame.

Vertices are integers of as many bits as Draco has, so that both decode to about the same mesh.
"""

from __future__ import annotations

import struct
from typing import Any

import meshoptimizer as library
import numpy as np
import zstandard

from benchmarks.assets.corners import Corners
from benchmarks.codecs import Setting
from nispcodec.core.arrays import AnyArray, Float64Array, Int32Array

LEVEL = 19
# Indices, vertices and bytes of the first frame; then the corner and the step of both grids.
HEADER = struct.Struct("<3I7f")


def on_grid(values: AnyArray, bits: int) -> tuple[Int32Array, list[float]]:
    """Values (n, c) as integers of `bits` bits over the largest extent; their corner and step."""
    low = values.min(axis=0)
    step = max(float(np.ptp(values, axis=0).max()), 1e-9) / (2**bits - 1)
    return np.rint((values - low) / step).astype(np.int32), [*low.tolist(), step]


def encode_corners(corners: Corners, setting: Setting) -> bytes:
    """Any mesh, with `qp` bits a coordinate and `qt` bits a texture coordinate."""
    positions, place = on_grid(corners.positions, int(setting["qp"]))
    uvs, uv_place = on_grid(corners.uvs, int(setting["qt"]))
    # Bytes of a vertex must be a multiple of four.
    columns = np.column_stack([positions, uvs, corners.materials]).astype(np.uint16)
    rows, inverse = np.unique(columns, axis=0, return_inverse=True)
    indices = inverse[corners.faces.ravel()].astype(np.uint32)
    ordered, fetched, size = np.empty_like(indices), np.empty_like(rows), rows[0].nbytes
    library.optimize_vertex_cache(ordered, indices, len(indices), len(rows))
    used = library.optimize_vertex_fetch(fetched, ordered, rows, len(ordered), len(rows), size)
    parts = [
        library.encode_index_buffer(ordered, len(ordered), used),
        library.encode_vertex_buffer(fetched[:used].copy(), used, size),
    ]
    first, second = (zstandard.ZstdCompressor(LEVEL).compress(bytes(part)) for part in parts)
    header = HEADER.pack(len(ordered), used, len(first), *place, *uv_place)
    return header + first + second


def decode_corners(data: bytes) -> Corners:
    """The mesh in such bytes."""
    count, used, size, *places = HEADER.unpack_from(data)
    frames = data[HEADER.size : HEADER.size + size], data[HEADER.size + size :]
    first, second = (zstandard.ZstdDecompressor().decompress(frame) for frame in frames)
    indices: Any = library.decode_index_buffer(count, 4, first)
    # Of one item a vertex: the binding allocates that many items, whatever their size.
    row = np.dtype((np.void, 12))
    rows = library.decode_vertex_buffer(used, row.itemsize, second, dtype=row)
    columns = np.frombuffer(np.asarray(rows).tobytes(), "<u2").reshape(used, 6)
    low, step, uv_low, uv_step = places[:3], places[3], places[4:6], places[6]
    positions: Float64Array = columns[:, :3] * step + low
    return Corners(
        positions,
        columns[:, 3:5] * uv_step + uv_low,
        columns[:, 5].astype(np.int32),
        np.asarray(indices).reshape(-1, 3).astype(np.uint32),
    )
