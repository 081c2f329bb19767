"""Wavefront OBJ: polygons with a material each, and an index of its own for every corner's UV."""

from __future__ import annotations

import math
import re
from array import array
from collections.abc import Callable, Sequence
from itertools import chain, count, repeat

import numpy as np

from nispcodec.core.arrays import Float64Array, Int32Array, Int64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.counted import counted
from nispcodec.core.errors import MeshError
from nispcodec.io.folder import Folder
from nispcodec.io.read import wavefront
from nispcodec.io.read.coordinates import without_unusable
from nispcodec.io.read.normals import with_creases
from nispcodec.io.read.obj_materials import MaterialReader, Meant, Placement
from nispcodec.io.read.polygons import triangulate

# Statements that carry nothing we could lose: grouping, display.
_SILENT = frozenset(
    b"o g mg lod shadow_obj trace_obj usemap maplib bevel c_interp d_interp".split()
)
# ZBrush's colors of vertices, in comments.
_POLYPAINT = re.compile(rb"(?:^|[\r\n])[ \t]*#MRGB\s")
_LARGEST_INDEX = 2**31 - 1
# Positions that are no numbers: a file with more of them is not looked through to its end.
_MOST_UNUSABLE = 1000
# A corner whose indices count from the file's start, and are none too large.
_PLAIN = rb"([1-9]\d{0,8})"
_PLAIN_CORNER = re.compile(rb"%b(?:/%b?(?:/%b?)?)?" % (_PLAIN, _PLAIN, _PLAIN))


def read_obj(data: bytes, name: str, folder: Folder) -> TexturedMesh:
    """Parse an OBJ file, and the MTL files and images that it names in `folder`.

    Faces may come before the vertices they use. Raises MeshError, naming the file `name` and the
    line, for positions and indices that make no sense.
    """
    statements = _Statements(name)
    statements.parse(data)
    warnings = statements.warnings()
    materials = MaterialReader(folder, warnings)
    for line, reference in statements.libraries:
        materials.open_library(reference, f"{name}:{line}")
    return _assemble(statements, materials, warnings)


class _Statements:
    """The statements of one OBJ file, in flat arrays; indices count from 0, -1 stands for none."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.line = 0
        self.positions = array("d")
        self.uvs = array("d")
        self.normals = array("d")
        self.different_corners = array("q")  # position, UV and normal of each
        self.corners = array("q")  # of all faces, which of the different ones
        self.smoothing = array("q")
        self.smoothed = False
        self.sizes = array("q")
        self.face_lines = array("q")
        self.face_materials = array("q")
        # Names, and how many `mtllib` statements were before them.
        self.materials: dict[tuple[str, int], int] = {}
        self.libraries: list[tuple[int, str]] = []
        self.left_out: dict[str, int] = {}
        self.unusable: dict[int, MeshError] = {}  # by the number of the position
        self._material = ("", 0)
        self._group = 0
        # Most corners come up in several faces: half the parsing time saved.
        self._known_corners: dict[bytes, int] = {}
        self._handlers: dict[bytes, Callable[[bytes], None]] = {
            b"v": self._position,
            b"vt": self._uv,
            b"vn": self._normal,
            b"s": self._smoothing_group,
            b"f": self._face,
            b"fo": self._face,
            b"usemtl": self._use_material,
            b"mtllib": self._library,
        }
        self._run_handlers: dict[bytes, Callable[[Sequence[bytes]], bool]] = {
            b"v ": self._position_run,
            b"vt": self._uv_run,
            b"vn": self._normal_run,
            b"f ": self._face_run,
        }

    def parse(self, data: bytes) -> None:
        # Nearly no file has it, and to look for the bare word takes no time.
        paint = _POLYPAINT.search(data) if b"#MRGB" in data else None
        if paint is not None:
            self.line = len(data[: paint.end() - 1].splitlines())
            self._leave_out("vertex colors")
        for first, beginning, lines in wavefront.runs(data):
            self.line = first
            at_once = self._run_handlers.get(beginning)
            if at_once is None or not at_once(lines):
                for self.line, line in wavefront.joined(lines, first):
                    self._parse_line(line)

    def _parse_line(self, line: bytes) -> None:
        keyword = line.split(None, 1)[0]
        handler = self._handlers.get(keyword)
        if handler is not None:
            handler(line)
        elif keyword not in _SILENT:
            self._leave_out(f"statement {wavefront.text(keyword[:32])!r}")

    def corner_indices(self) -> tuple[Int64Array, Int64Array, Int64Array]:
        """Position, UV and normal (n,) of every corner of every face."""
        position, uv, normal = _integers(self.different_corners).reshape(-1, 3).T
        corners = _integers(self.corners)
        return position[corners], uv[corners], normal[corners]

    def warnings(self) -> list[str]:
        return [
            f"{self.name}: left out {what}, first in line {line}"
            for what, line in self.left_out.items()
        ]

    def _leave_out(self, what: str) -> None:
        # A binary file under this name must not end in a million warnings.
        if len(self.left_out) < 20:
            self.left_out.setdefault(what, self.line)

    def _place(self) -> str:
        return f"{self.name}:{self.line}"

    def _position(self, line: bytes) -> None:
        words = line.split()
        try:
            self.positions.extend(wavefront.numbers(words[1:], 3, self._place())[:3])
        except MeshError as why:
            self._unusable_position(why)
        if len(words) > 6:
            self._leave_out("vertex colors")

    def _unusable_position(self, why: MeshError) -> None:
        """Stand 0 in for a position that only faces which use it make an error."""
        if len(self.unusable) == _MOST_UNUSABLE:
            raise why
        self.unusable[len(self.positions) // 3] = why
        self._leave_out("positions that are no finite numbers and that no face uses")
        self.positions.extend((0.0,) * 3)

    def _uv(self, line: bytes) -> None:
        words = line.split()[1:]
        if wavefront.not_finite(words[:2]):
            self.uvs.extend((math.nan, math.nan))
            return
        try:
            u, v, *_ = *wavefront.numbers(words[:2], 1, self._place()), 0.0
        except MeshError:
            # Unusable, as NaN is: it costs the faces at it their UVs, and not the asset.
            self._leave_out(f"texture coordinates {wavefront.text(b' '.join(words[:2])[:32])!r}")
            u = v = math.nan
        self.uvs.extend((u, v))

    def _normal(self, line: bytes) -> None:
        words = line.split()[1:4]
        try:
            self.normals.extend(wavefront.numbers(words, 3, self._place()))
        except MeshError:
            # Shading is no reason to refuse an asset: faces without normals are flat.
            self._leave_out(f"normal {wavefront.text(b' '.join(words)[:32])!r}")
            self.normals.extend((math.nan,) * 3)

    def _smoothing_group(self, line: bytes) -> None:
        """A number; 0, or anything else such as "off", is none."""
        word = wavefront.rest(line)
        is_number = word.isascii() and word.isdigit() and len(word) < 10
        self._group, self.smoothed = int(word) if is_number else 0, True

    def _face(self, line: bytes) -> None:
        words = line.split()[1:]
        if len(words) < 3:
            self._leave_out("faces of fewer than three corners")
            return
        for word in words:
            known = self._known_corners.get(word)
            self.corners.append(self._corner(word) if known is None else known)
        self.sizes.append(len(words))
        self.smoothing.append(self._group)
        self.face_lines.append(self.line)
        self.face_materials.append(self._material_number())

    def _material_number(self) -> int:
        return self.materials.setdefault(self._material, len(self.materials))

    def _corner(self, word: bytes) -> int:
        """The number of a corner "1", "1/2", "1//3" or "1/2/3" of position, UV and normal."""
        parts = word.split(b"/")
        position = self._index(parts[0], len(self.positions) // 3)
        has_uv = len(parts) > 1 and parts[1]
        uv = self._index(parts[1], len(self.uvs) // 2) if has_uv else -1
        normal = self._normal_index(parts[2]) if len(parts) > 2 and parts[2] else -1
        number = len(self.different_corners) // 3
        self.different_corners.extend((position, uv, normal))
        if b"-" not in word:  # what counts back means something else in each face
            self._known_corners[word] = number
        return number

    def _normal_index(self, word: bytes) -> int:
        """As `_index`; -1 for what is no index."""
        try:
            return self._index(word, len(self.normals) // 3)
        except MeshError:
            self._leave_out("normals that there are none of")
            return -1

    def _index(self, word: bytes, count: int) -> int:
        """From 0: positive words count from the file's start, negative ones back from here."""
        try:
            index = int(word)
        except ValueError:
            index = 0
        if 0 < index <= _LARGEST_INDEX:
            return index - 1
        if -count <= index < 0:
            return count + index
        raise MeshError(
            f"{self._place()}: expected an index from 1 up or from -1 down to -{count}, "
            f"found {wavefront.text(word[:32])!r}"
        )

    # Many lines that begin alike, at once; False, and nothing done, where one has another form
    # than most files have.

    def _position_run(self, lines: Sequence[bytes]) -> bool:
        rows = wavefront.table(lines, b"v", 3)
        if rows is None:
            return False
        self.positions.frombytes(rows[:, :3].tobytes())
        if rows.shape[1] > 5:
            self._leave_out("vertex colors")
        return True

    def _uv_run(self, lines: Sequence[bytes]) -> bool:
        rows = wavefront.table(lines, b"vt", 2)
        if rows is not None:
            self.uvs.frombytes(rows[:, :2].tobytes())
        return rows is not None

    def _normal_run(self, lines: Sequence[bytes]) -> bool:
        rows = wavefront.table(lines, b"vn", 3)
        if rows is not None:
            self.normals.frombytes(rows[:, :3].tobytes())
        return rows is not None

    def _face_run(self, lines: Sequence[bytes]) -> bool:
        words = b" ".join(lines).split()
        new = list(set(words) - self._known_corners.keys() - {b"f"})
        plain = [match.groups(b"0") for match in map(_PLAIN_CORNER.fullmatch, new) if match]
        if len(plain) < len(new):
            return False
        self._known_corners.update(zip(new, count(len(self.different_corners) // 3)))
        self.different_corners.extend(int(index) - 1 for index in chain.from_iterable(plain))
        numbers = map(self._known_corners.get, words, repeat(-1))
        corners = np.fromiter(numbers, np.int64, len(words))
        starts = np.flatnonzero(corners < 0)
        sizes = np.diff(starts, append=len(words)) - 1
        if len(starts) != len(lines) or sizes.min() < 3:
            return False
        self.corners.frombytes(corners[corners >= 0].tobytes())
        self.sizes.frombytes(sizes.tobytes())
        self.smoothing.extend(repeat(self._group, len(lines)))
        self.face_lines.extend(range(self.line, self.line + len(lines)))
        self.face_materials.extend(repeat(self._material_number(), len(lines)))
        return True

    def _use_material(self, line: bytes) -> None:
        self._material = (wavefront.rest(line), len(self.libraries))

    def _library(self, line: bytes) -> None:
        self.libraries.append((self.line, wavefront.rest(line)))


def _assemble(
    statements: _Statements, materials: MaterialReader, warnings: list[str]
) -> TexturedMesh:
    positions = _rows(statements.positions, 3)
    uvs = _rows(statements.uvs, 2)
    sizes = _integers(statements.sizes)
    corners, corner_uvs, corner_normals = statements.corner_indices()
    _expect_indices(statements, corners, len(positions))
    _expect_usable(statements, corners)
    corner_uvs = _known_uvs(statements, corner_uvs, len(uvs), warnings)
    triangles, owner = triangulate(positions[corners], sizes)
    uv_faces = _whole_or_none(corner_uvs[triangles], warnings, statements.name)
    meant, numbers = _resolved(list(statements.materials), materials)
    face_materials = numbers[_integers(statements.face_materials)[owner]]
    made = materials.materials(meant)
    placements = list(map(materials.placement, meant))
    uvs, placed = _placed(uvs, uv_faces.astype(np.int64), face_materials, placements)
    uvs, placed = without_unusable(uvs, placed, statements.name, warnings)
    _warn_of_normals(statements, corner_normals, warnings)
    mesh = TexturedMesh(
        positions=positions,
        faces=corners[triangles].astype(np.int32),
        uvs=uvs,
        uv_faces=placed.astype(np.int32),
        face_materials=face_materials.astype(np.int32),
        materials=made,
        textures=tuple(materials.textures),
        warnings=tuple(warnings),
    )
    return _creased(mesh, statements, corner_normals[triangles], owner)


def _warn_of_normals(
    statements: _Statements, corner_normals: Int64Array, warnings: list[str]
) -> None:
    beyond = corner_normals >= len(statements.normals) // 3
    if beyond.any():
        warnings.append(
            f"{statements.name}: {beyond.sum()} corners name a normal that is not there"
        )


def _creased(
    mesh: TexturedMesh, statements: _Statements, numbers: Int64Array, owner: Int64Array
) -> TexturedMesh:
    """With the creases of the file's normals and smoothing groups, if it has any.

    numbers: (m, 3) of the corners' normals; changed where there are none of that number.
    """
    rows = _rows(statements.normals, 3)
    numbers[numbers >= len(rows)] = -1
    if not statements.smoothed and (numbers < 0).all():
        return mesh
    normals = np.vstack([rows, np.full((1, 3), np.nan)])[numbers]
    return with_creases(mesh, normals, _integers(statements.smoothing)[owner])


def _resolved(
    written: list[tuple[str, int]], materials: MaterialReader
) -> tuple[list[Meant], Int64Array]:
    """The different materials that an OBJ's names mean, and the number there of each name."""
    resolved = [materials.resolved(*name) for name in written]
    numbers = {meant: number for number, meant in enumerate(dict.fromkeys(resolved))}
    return list(numbers), np.array([numbers[meant] for meant in resolved], dtype=np.int64)


def _placed(
    uvs: Float64Array,
    uv_faces: Int64Array,
    face_materials: Int64Array,
    placements: list[Placement],
) -> tuple[Float64Array, Int64Array]:
    """UVs and faces, with rows of their own for materials whose maps do not lie on the file's."""
    rows, faces = [uvs], uv_faces.copy()
    for number, placement in enumerate(placements):
        chosen = (face_materials == number)[:, None] & (uv_faces >= 0)
        if placement == Placement() or not chosen.any():
            continue
        used, inverse = np.unique(uv_faces[chosen], return_inverse=True)
        faces[chosen] = sum(map(len, rows)) + inverse
        rows.append(placement.apply(uvs[used]))
    return np.concatenate(rows), faces


def _rows(values: array[float], columns: int) -> Float64Array:
    return np.array(values, dtype=np.float64).reshape(-1, columns)


def _integers(values: array[int]) -> Int64Array:
    return np.array(values, dtype=np.int64)


def _expect_indices(statements: _Statements, indices: Int64Array, count: int) -> None:
    if indices.size and indices.max() >= count:
        raise MeshError(_first_beyond(statements, indices, count, "vertex"))


def _expect_usable(statements: _Statements, indices: Int64Array) -> None:
    used = indices[np.isin(indices, list(statements.unusable))]
    if used.size:
        raise statements.unusable[int(used.min())]


def _known_uvs(
    statements: _Statements, indices: Int64Array, count: int, warnings: list[str]
) -> Int64Array:
    """The indices of texture coordinates, -1 for those that the file does not have."""
    if not indices.size or indices.max() < count:
        return indices
    said = _first_beyond(statements, indices, count, "texture coordinate")
    warnings.append(f"{said}: left out where it is so")
    return np.where(indices < count, indices, -1)


def _first_beyond(statements: _Statements, indices: Int64Array, count: int, what: str) -> str:
    corner = int(np.argmax(indices >= count))
    face = int(np.searchsorted(np.cumsum(_integers(statements.sizes)), corner, side="right"))
    return (
        f"{statements.name}:{statements.face_lines[face]}: expected a {what} index up to {count}, "
        f"found {indices[corner] + 1}"
    )


def _whole_or_none(uv_faces: Int64Array, warnings: list[str], name: str) -> Int32Array:
    """A face with UVs in some corners only has none."""
    missing = uv_faces.min(axis=1, initial=0) < 0
    partial = int((missing & (uv_faces.max(axis=1, initial=-1) >= 0)).sum())
    if partial:
        warnings.append(
            f"{name}: texture coordinates in some corners only of {counted(partial, 'face')}"
        )
    return np.where(missing[:, None], -1, uv_faces).astype(np.int32)
