"""STL and OFF: formats that hold geometry alone."""

from __future__ import annotations

import re
import struct
from collections.abc import Iterator

import numpy as np

from nispcodec.core.arrays import Float64Array, Int64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.errors import MeshError
from nispcodec.io.folder import Folder
from nispcodec.io.read import wavefront
from nispcodec.io.read.polygons import triangulate

Lines = Iterator[tuple[int, bytes]]

_STL_HEADER, _STL_FACET = 84, 50
_OFF_KEYWORD = re.compile(rb"(ST)?C?N?OFF")


def read_stl(data: bytes, name: str, folder: Folder) -> TexturedMesh:
    """Parse a binary or text STL file; every face has vertices of its own."""
    if len(data) >= _STL_HEADER:
        (count,) = struct.unpack_from("<I", data, _STL_HEADER - 4)
        if len(data) == _STL_HEADER + _STL_FACET * count:
            return geometry_only(*_binary_facets(data, count, name), name)
    if not data.lstrip()[:5].lower() == b"solid":
        raise MeshError(f"{name}: expected text, or facets of {_STL_FACET} bytes to the end")
    return geometry_only(*_text_facets(data, name), name)


def read_off(data: bytes, name: str, folder: Folder) -> TexturedMesh:
    """Parse a text OFF file; what follows x, y, z on a vertex line is left out."""
    lines = wavefront.logical_lines(data)
    vertices, faces = _off_counts(lines, name)
    rows = [
        wavefront.numbers(line.split(), 3, f"{name}:{number}")[:3]
        for number, line in _take(lines, vertices, f"{name}: expected {vertices} vertices")
    ]
    sizes, corners = [], []
    for number, line in _take(lines, faces, f"{name}: expected {faces} faces"):
        face = _off_face(line.split(), vertices, f"{name}:{number}")
        sizes.append(len(face))
        corners.extend(face)
    positions = np.array(rows, dtype=np.float64).reshape(-1, 3)
    indices = np.array(corners, dtype=np.int64)
    triangles, _ = triangulate(positions[indices], np.array(sizes, dtype=np.int64))
    return geometry_only(positions, indices[triangles], name)


def geometry_only(positions: Float64Array, faces: Int64Array, name: str) -> TexturedMesh:
    """A mesh without UVs, of one material."""
    return TexturedMesh(
        positions=positions,
        faces=faces.astype(np.int32),
        uvs=np.zeros((0, 2)),
        uv_faces=np.full(faces.shape, -1, dtype=np.int32),
        face_materials=np.zeros(len(faces), dtype=np.int32),
        name=name,
    )


def _binary_facets(data: bytes, count: int, name: str) -> tuple[Float64Array, Int64Array]:
    facet = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    corners = np.frombuffer(data, facet, count, _STL_HEADER)["corners"]
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


def _off_counts(lines: Lines, name: str) -> tuple[int, int]:
    number, line = next(lines, (1, b""))
    keyword = _OFF_KEYWORD.match(line)
    if keyword is None or b"BINARY" in line:
        raise MeshError(f"{name}:{number}: expected the keyword OFF and text, found {line[:20]!r}")
    rest = line[keyword.end() :]
    if not rest.strip():
        number, rest = next(lines, (number, b""))
    words = rest.split()
    if len(words) < 2 or not all(word.isdigit() and len(word) < 10 for word in words[:2]):
        raise MeshError(
            f"{name}:{number}: expected counts of vertices and faces, found {rest[:40]!r}"
        )
    return int(words[0]), int(words[1])


def _take(lines: Lines, count: int, expected: str) -> Lines:
    for done in range(count):
        found = next(lines, None)
        if found is None:
            raise MeshError(f"{expected}, found {done} before the end of the file")
        yield found


def _off_face(words: list[bytes], vertices: int, place: str) -> list[int]:
    try:
        size = int(words[0])
        face = [int(word) for word in words[1 : size + 1]]
    except ValueError:
        size, face = 0, []
    if size < 3 or len(face) != size or not all(0 <= index < vertices for index in face):
        shown = wavefront.text(b" ".join(words[:8]))
        raise MeshError(
            f"{place}: expected a count from 3 and as many indices below {vertices}, "
            f"found {shown!r}"
        )
    return face
