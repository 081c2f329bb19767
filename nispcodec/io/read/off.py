"""OFF: polygons in text, geometry alone."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from nispcodec.core.asset import TexturedMesh
from nispcodec.core.errors import MeshError
from nispcodec.io.folder import Folder
from nispcodec.io.read import wavefront
from nispcodec.io.read.polygons import triangulate

Lines = Iterator[tuple[int, bytes]]

_KEYWORD = re.compile(rb"(ST)?C?N?OFF")


def read_off(data: bytes, name: str, folder: Folder) -> TexturedMesh:
    """Parse a text OFF file; what follows x, y, z on a vertex line is left out.

    OFF names no other files: `folder` is not looked at. Raises MeshError, naming the file `name`
    and the line, for a malformed file.
    """
    lines = wavefront.logical_lines(data)
    vertices, faces = _counts(lines, name)
    rows = [
        wavefront.numbers(line.split(), 3, f"{name}:{number}")[:3]
        for number, line in _take(lines, vertices, f"{name}: expected {vertices} vertices")
    ]
    sizes, corners = [], []
    for number, line in _take(lines, faces, f"{name}: expected {faces} faces"):
        face = _face(line.split(), vertices, f"{name}:{number}")
        sizes.append(len(face))
        corners.extend(face)
    positions = np.array(rows, dtype=np.float64).reshape(-1, 3)
    indices = np.array(corners, dtype=np.int64)
    triangles, _ = triangulate(positions[indices], np.array(sizes, dtype=np.int64))
    return TexturedMesh.geometry_only(positions, indices[triangles], name)


def _counts(lines: Lines, name: str) -> tuple[int, int]:
    number, line = next(lines, (1, b""))
    keyword = _KEYWORD.match(line)
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


def _face(words: list[bytes], vertices: int, place: str) -> list[int]:
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
