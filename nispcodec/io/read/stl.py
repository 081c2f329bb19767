"""STL: triangles in binary or text, geometry alone."""

from __future__ import annotations

import struct

import numpy as np

from nispcodec.core.arrays import Float64Array, Int64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.errors import MeshError
from nispcodec.io.folder import Folder
from nispcodec.io.read import wavefront

_HEADER, _FACET = 84, 50


def read_stl(data: bytes, name: str, folder: Folder) -> TexturedMesh:
    """Parse a binary or text STL file; every face has vertices of its own.

    STL names no other files: `folder` is not looked at. Raises MeshError, naming the file `name`
    and the place in it, for a malformed file.
    """
    if len(data) >= _HEADER:
        (count,) = struct.unpack_from("<I", data, _HEADER - 4)
        if len(data) == _HEADER + _FACET * count:
            return TexturedMesh.geometry_only(*_binary_facets(data, count, name), name)
    if not data.lstrip()[:5].lower() == b"solid":
        raise MeshError(f"{name}: expected text, or facets of {_FACET} bytes to the end")
    return TexturedMesh.geometry_only(*_text_facets(data, name), name)


def _binary_facets(data: bytes, count: int, name: str) -> tuple[Float64Array, Int64Array]:
    facet = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    corners = np.frombuffer(data, facet, count, _HEADER)["corners"]
    finite = np.isfinite(corners).all(axis=(1, 2))
    if not finite.all():
        raise MeshError(
            f"{name}: facet {int(finite.argmin())}: expected finite coordinates, "
            f"found NaN or infinity"
        )
    return corners.reshape(-1, 3).astype(np.float64), np.arange(3 * count).reshape(-1, 3)


def _text_facets(data: bytes, name: str) -> tuple[Float64Array, Int64Array]:
    rows: list[list[float]] = []
    for number, line in wavefront.logical_lines(data):
        words = line.lower().split()
        if words[0] == b"vertex":
            rows.append(wavefront.numbers(words[1:4], 3, f"{name}:{number}"))
        elif words[0] == b"endloop" and (len(rows) % 3 or not rows):
            raise MeshError(f"{name}:{number}: expected three vertices in a loop, found other")
    if len(rows) % 3:
        raise MeshError(f"{name}: expected three vertices a facet, found {len(rows)} in all")
    positions = np.array(rows, dtype=np.float64).reshape(-1, 3)
    return positions, np.arange(len(rows)).reshape(-1, 3)
