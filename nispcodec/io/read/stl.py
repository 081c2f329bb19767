"""STL: triangles in binary or text, geometry alone."""

from __future__ import annotations

import struct
from dataclasses import replace

import numpy as np

from nispcodec.core.arrays import Float64Array, Int64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.errors import MeshError
from nispcodec.io.folder import Folder
from nispcodec.io.read import wavefront

_HEADER, _FACET = 84, 50
# Counts of those who stream, and do not know it when they write it.
_UNKNOWN = (0, 2**32 - 1)


def read_stl(data: bytes, name: str, folder: Folder) -> TexturedMesh:
    """Parse a binary or text STL file; every face has vertices of its own.

    STL names no other files: `folder` is not looked at. Raises MeshError, naming the file `name`
    and the place in it, for a malformed file.
    """
    if _is_text(data):
        return TexturedMesh.geometry_only(*_text_facets(data, name), name)
    if len(data) < _HEADER:
        raise MeshError(
            f"{name}: expected text from 'solid', or a header of {_HEADER} bytes, found {len(data)}"
        )
    warnings: list[str] = []
    facets = _binary_facets(data, _count(data, name, warnings), name, warnings)
    return replace(TexturedMesh.geometry_only(*facets, name), warnings=tuple(warnings))


def _is_text(data: bytes) -> bool:
    """Whether it is text: binary files begin with "solid" too, but their length or count tells."""
    if len(data) >= _HEADER and _stated_count(data) in (*_UNKNOWN, (len(data) - _HEADER) / _FACET):
        return False
    if data.startswith(wavefront.WIDE_MARKS):
        return True
    text = data.removeprefix(wavefront.BYTE_ORDER_MARK).lstrip()
    return text[:5].lower() == b"solid" and b"\0" not in data[:_HEADER]


def _stated_count(data: bytes) -> int:
    (count,) = struct.unpack_from("<I", data, _HEADER - 4)
    return int(count)


def _count(data: bytes, name: str, warnings: list[str]) -> int:
    """How many facets to read: as many as the header says, or, where it does not, as there are."""
    stated, there = _stated_count(data), (len(data) - _HEADER) // _FACET
    if stated in _UNKNOWN and there:
        warnings.append(f"{name}: the header says {stated} facets, {there} are read")
        stated = there
    if stated > there:
        raise MeshError(f"{name}: expected {stated} facets of {_FACET} bytes, found {there}")
    left = len(data) - _HEADER - _FACET * stated
    if left:
        warnings.append(f"{name}: left out {left} bytes after the facets")
    return stated


def _binary_facets(
    data: bytes, count: int, name: str, warnings: list[str]
) -> tuple[Float64Array, Int64Array]:
    facet = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    facets = np.frombuffer(data, facet, count, _HEADER)
    corners = facets["corners"]
    finite = np.isfinite(corners).all(axis=(1, 2))
    if not finite.all():
        raise MeshError(
            f"{name}: facet {int(finite.argmin())}: expected finite coordinates, "
            f"found NaN or infinity"
        )
    # VisCAM sets the highest bit of colors, Magics has them in the header too.
    if b"COLOR=" in data[:_HEADER] or (facets["attribute"] & 0x8000).any():
        warnings.append(f"{name}: left out facet colors")
    return corners.reshape(-1, 3).astype(np.float64), np.arange(3 * count).reshape(-1, 3)


def _text_facets(data: bytes, name: str) -> tuple[Float64Array, Int64Array]:
    rows: list[list[float]] = []
    whole = 0
    for number, line in wavefront.logical_lines(data):
        words = line.lower().split()
        if words[0] == b"vertex":
            rows.append(wavefront.numbers(words[1:4], 3, f"{name}:{number}"))
        elif words[0] == b"endloop":
            if len(rows) - whole != 3:
                raise MeshError(
                    f"{name}:{number}: expected three vertices in a loop, found {len(rows) - whole}"
                )
            whole = len(rows)
    if len(rows) != whole:
        raise MeshError(f"{name}: expected an endloop after three vertices, found the end")
    positions = np.array(rows, dtype=np.float64).reshape(-1, 3)
    return positions, np.arange(len(rows)).reshape(-1, 3)
