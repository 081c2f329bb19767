"""OFF: polygons in text, with texture coordinates in STOFF and normals in NOFF."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.errors import MeshError
from nispcodec.io.folder import Folder
from nispcodec.io.read import wavefront
from nispcodec.io.read.coordinates import without_unusable, without_unused
from nispcodec.io.read.normals import with_creases
from nispcodec.io.read.polygons import triangulate

Lines = Iterator[tuple[int, bytes]]

_KEYWORD = re.compile(rb"(ST)?C?N?OFF|off")


def read_off(data: bytes, name: str, folder: Folder) -> TexturedMesh:
    """Parse a text OFF file: positions, faces, texture coordinates of STOFF, normals of NOFF.

    OFF names no other files: `folder` is not looked at. Raises MeshError, naming the file `name`
    and the line, for a malformed file.
    """
    lines = wavefront.logical_lines(data)
    kind, vertices, faces = _head(lines, name)
    said = _LeftOut(name)
    unusable: dict[int, str] = {}
    positions, normals, uvs = _vertices(lines, vertices, kind, said, unusable)
    sizes, corners = [], []
    for number, line in _take(lines, faces, f"{name}: expected {faces} faces"):
        face, others = _face(line.split(), vertices, f"{name}:{number}")
        said.add("face colors", len(others))
        said.add("faces of fewer than three corners", len(face) < 3)
        if len(face) > 2:
            sizes.append(len(face))
            corners.extend(face)
    said.add("lines after the last face", sum(1 for _ in lines))
    indices = np.array(corners, dtype=np.int64)
    _expect_unused(unusable, corners)
    positions = without_unused(positions, indices, name, said.warnings)
    triangles, _ = triangulate(positions[indices], np.array(sizes, dtype=np.int64))
    mesh = TexturedMesh.geometry_only(positions, indices[triangles], name)
    if uvs is not None:
        used, uv_faces = without_unusable(uvs, indices[triangles], name, said.warnings)
        mesh = replace(mesh, uvs=used, uv_faces=uv_faces.astype(np.int32))
    mesh = replace(mesh, warnings=tuple(said.warnings))
    return mesh if normals is None else with_creases(mesh, normals[mesh.faces])


class _LeftOut:
    """Warnings of what is left out, each kind once."""

    def __init__(self, name: str) -> None:
        self.warnings: list[str] = []
        self.name = name

    def add(self, what: str, there: int) -> None:
        warning = f"{self.name}: left out {what}"
        if there and warning not in self.warnings:
            self.warnings.append(warning)


def _vertices(
    lines: Lines, count: int, kind: bytes, said: _LeftOut, unusable: dict[int, str]
) -> tuple[Float64Array, Float64Array | None, Float64Array | None]:
    """Positions (n, 3), and normals (n, 3) and UVs (n, 2) where the `kind` has them.

    A line is x y z [normal] [color] [s t]. Why a position that is not finite is no position comes
    into `unusable`, by its index: faces may do without it.
    """
    rows: list[list[float]] = []
    normals, uvs = [], []
    textured, shaded = kind.startswith(b"ST"), b"N" in kind
    known = 3 + 3 * shaded + 2 * textured
    for number, line in _take(lines, count, f"{said.name}: expected {count} vertices"):
        words, place = line.split(), f"{said.name}:{number}"
        rows.append(_position(words[:3], place, len(rows), unusable))
        if shaded:
            normals.append(_numbers(words[3:6], 3, place))
        if textured:
            uvs.append(_numbers(words[3:][-2:], 2, place))
        said.add("vertex colors", len(words) > known)
    return (
        np.array(rows, dtype=np.float64).reshape(-1, 3),
        np.array(normals, dtype=np.float64).reshape(-1, 3) if shaded else None,
        np.array(uvs, dtype=np.float64).reshape(-1, 2) if textured else None,
    )


def _position(words: list[bytes], place: str, index: int, unusable: dict[int, str]) -> list[float]:
    """Three numbers; NaN where they are not finite. Raises MeshError where they are none."""
    try:
        return wavefront.numbers(words, 3, place)
    except MeshError as why:
        if len(words) < 3 or not wavefront.not_finite(words):
            raise
        unusable[index] = str(why)
        return [math.nan] * 3


def _expect_unused(unusable: dict[int, str], corners: list[int]) -> None:
    used = unusable.keys() & set(corners) if unusable else set()
    if used:
        raise MeshError(unusable[min(used)])


def _numbers(words: list[bytes], count: int, place: str) -> list[float]:
    """So many numbers; NaN where one of them is not finite, or missing."""
    if len(words) < count or wavefront.not_finite(words):
        return [math.nan] * count
    return wavefront.numbers(words, count, place)


def _head(lines: Lines, name: str) -> tuple[bytes, int, int]:
    """The keyword, and the counts of vertices and faces."""
    number, line = next(lines, (1, b""))
    if line[:1].isdigit() and b"OFF" not in line:  # the keyword may be missing
        line = b"OFF " + line
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
    return keyword[0], int(words[0]), int(words[1])


def _take(lines: Lines, count: int, expected: str) -> Lines:
    for done in range(count):
        found = next(lines, None)
        if found is None:
            raise MeshError(f"{expected}, found {done} before the end of the file")
        yield found


def _face(words: list[bytes], vertices: int, place: str) -> tuple[list[int], list[bytes]]:
    """The corners of a face, and what follows them."""
    try:
        size = int(words[0])
        face = [int(word) for word in words[1 : max(size, 0) + 1]]
    except ValueError:
        size, face = -1, []
    if size < 0 or len(face) != size or not all(0 <= index < vertices for index in face):
        shown = wavefront.text(b" ".join(words[:8]))
        raise MeshError(
            f"{place}: expected a count and as many indices below {vertices}, found {shown!r}"
        )
    return face, words[size + 1 :]
