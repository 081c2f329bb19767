"""PLY: polygons in text or binary, with a UV for each vertex or corner, and textures by name."""

from __future__ import annotations

import math
import re
import struct
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePath

import numpy as np

from nispcodec.core.arrays import Float64Array, Int64Array
from nispcodec.core.asset import Material, Texture, TexturedMesh, TextureMap
from nispcodec.core.errors import MeshError
from nispcodec.io.folder import Folder
from nispcodec.io.images import TextureShelf
from nispcodec.io.read import wavefront
from nispcodec.io.read.coordinates import without_unusable
from nispcodec.io.read.names import material_name
from nispcodec.io.read.normals import with_creases
from nispcodec.io.read.polygons import triangulate

_TYPES = {
    "char": "b", "int8": "b", "uchar": "B", "uint8": "B", "short": "h", "int16": "h",
    "ushort": "H", "uint16": "H", "int": "i", "int32": "i", "uint": "I", "uint32": "I",
    "float": "f", "float32": "f", "double": "d", "float64": "d",
}  # fmt: skip
_ORDERS = {"binary_little_endian": "<", "binary_big_endian": ">"}
_UV_NAMES = (("s", "t"), ("u", "v"), ("texture_u", "texture_v"))
_XYZ = ("x", "y", "z")
_NORMAL = ("nx", "ny", "nz")
_COLORS = {"red", "diffuse_red", "ambient_red", "r"}
_KEYWORDS = {"ply", "format", "comment", "obj_info", "element", "property"}
# The line of its own, which a comment may quote.
_END = re.compile(rb"[\r\n]end_header[ \t]*(?:\r?\n|\r)")
# Comments before the name of an image, besides MeshLab's TextureFile.
_TEXTURE = re.compile(r"texture[_-]?(file|name|map)?[:=]?", re.IGNORECASE)


@dataclass(frozen=True)
class Property:
    """A column: its struct code, and that of its count when it is a list."""

    name: str
    code: str
    count_code: str = ""


@dataclass
class Element:
    """A table of the file; scalar columns are lists of numbers, list columns lists of lists."""

    name: str
    count: int
    properties: list[Property] = field(default_factory=list)
    columns: dict[str, list[float]] = field(default_factory=dict)
    lists: dict[str, list[Sequence[float]]] = field(default_factory=dict)


@dataclass
class Header:
    """A PLY header; `size` is its length in bytes.

    `textures` are the names of texture files, `likely_textures` what other comments seem to name,
    `unknown` the places of lines without a keyword: some exporters forget the word comment.
    """

    format: str
    elements: list[Element]
    textures: list[str]
    likely_textures: list[str]
    unknown: list[str]
    size: int


def read_ply(data: bytes, name: str, folder: Folder) -> TexturedMesh:
    """Parse a PLY file, and the images in `folder` that its comments name.

    Raises MeshError, naming the file `name` and the place in it, for a malformed file.
    """
    data = data.removeprefix(wavefront.BYTE_ORDER_MARK)
    header = parse_header(data, name)
    _read_elements(header, data, name)
    elements = {element.name: element for element in header.elements}
    vertex, face = elements.get("vertex"), elements.get("face")
    warnings = [f"{place}: left out a line of the header" for place in header.unknown]
    has_strips = "tristrips" in elements and (face is None or not face.count)
    if has_strips:
        face = _without_strips(elements["tristrips"])
    if vertex is None or face is None:
        raise MeshError(f"{name}: expected elements vertex and face, found {list(elements)}")
    used = {"vertex", "tristrips" if has_strips else "face"}
    others = [each.name for each in header.elements if each.count and each.name not in used]
    warnings.extend(f"{name}: left out element {other!r}" for other in others)
    for element in (vertex, face):
        if _COLORS & element.columns.keys():
            warnings.append(f"{name}: left out {element.name} colors")
    materials, textures = _materials(header, name, folder, warnings)
    return _assembled(vertex, face, materials, textures, warnings, name)


def parse_header(data: bytes, name: str) -> Header:
    """Parse the file up to and including the line `end_header`.

    Raises MeshError, naming the file `name` and the line, for a malformed header.
    """
    end = _END.search(data)
    if not data.startswith(b"ply") or end is None:
        raise MeshError(f"{name}: expected a header from 'ply' to 'end_header', found none")
    header = Header("", [], [], [], [], end.end())
    for number, line in enumerate(data[: end.start()].splitlines(), 1):
        words = wavefront.text(line).split()
        if words and words[0] not in _KEYWORDS:
            header.unknown.append(f"{name}:{number}")
            continue
        try:
            _header_line(header, words, line)
        except (ValueError, LookupError) as why:
            shown = wavefront.text(line[:60])
            raise MeshError(f"{name}:{number}: expected a PLY header, found {shown!r}") from why
    if header.format != "ascii" and header.format not in _ORDERS:
        raise MeshError(f"{name}: expected a PLY format, found {header.format!r}")
    _expect_different([element.name for element in header.elements], f"{name}: elements")
    for element in header.elements:
        names = [column.name for column in element.properties]
        _expect_different(names, f"{name}: properties of {element.name}")
    return header


def _expect_different(names: Sequence[str], place: str) -> None:
    repeated = [each for index, each in enumerate(names) if each in names[:index]]
    if repeated:
        raise MeshError(f"{place}: expected different names, found {repeated[0]!r} twice")


def _without_strips(strips: Element) -> Element:
    """Strips, with -1 between them, as faces: every second triangle is the other way round."""
    listed = strips.lists.get("vertex_indices") or strips.lists.get("vertex_index") or []
    flat = np.array([index for strip in listed for index in (*strip, -1)], dtype=np.float64)
    place = np.arange(len(flat))
    since = place - np.maximum.accumulate(np.where(flat < 0, place + 1, 0))
    first = np.flatnonzero((since[2:] >= 2) & (flat[2:] >= 0))
    odd = since[first + 2] % 2
    faces = flat[np.stack([first, first + 1 + odd, first + 2 - odd], axis=1)]
    return Element("face", len(faces), lists={"vertex_indices": faces.tolist()})


def _header_line(header: Header, words: list[str], line: bytes) -> None:
    match words:
        case ["format", found, "1.0"]:
            header.format = found
        case ["comment", "TextureFile", _, *_]:
            header.textures.append(wavefront.rest(line, 2))
        case ["comment", key, _, *_] if _TEXTURE.fullmatch(key):
            header.likely_textures.append(wavefront.rest(line, 2))
        case ["element", found, count]:
            if not 0 <= int(count) < 2**31:
                raise ValueError(count)
            header.elements.append(Element(found, int(count)))
        case ["property", "list", count, item, found]:
            header.elements[-1].properties.append(Property(found, _TYPES[item], _TYPES[count]))
        case ["property", item, found]:
            header.elements[-1].properties.append(Property(found, _TYPES[item]))
        case ["ply"] | ["comment", *_] | ["obj_info", *_] | []:
            pass
        case _:
            raise ValueError(words)


class _Text:
    """The body of a text file as a queue of numbers."""

    def __init__(self, body: bytes) -> None:
        self._words = body.split()
        self._at = 0

    @property
    def left(self) -> int:
        """No more numbers than this are there."""
        return len(self._words) - self._at

    def take(self, codes: str) -> Sequence[float]:
        words = self._words[self._at : self._at + len(codes)]
        self._at += len(codes)
        if len(words) < len(codes):
            raise ValueError("the end of the file")
        try:
            return [float(word) for word in words]
        except ValueError:
            return [_number(word) for word in words]


def _number(word: bytes) -> float:
    """NaN for what any C library writes for no finite number. Raises ValueError for other words."""
    return math.nan if wavefront.not_finite([word]) else float(word)


class _Binary:
    """The body of a binary file as a queue of numbers."""

    def __init__(self, body: bytes, order: str) -> None:
        self._body = body
        self._order = order
        self._at = 0

    @property
    def left(self) -> int:
        """No more numbers than this are there."""
        return len(self._body) - self._at

    def take(self, codes: str) -> Sequence[float]:
        layout = self._order + codes
        size = struct.calcsize(layout)
        if self._at + size > len(self._body):
            raise ValueError("the end of the file")
        values = struct.unpack_from(layout, self._body, self._at)
        self._at += size
        return values


def _read_elements(header: Header, data: bytes, name: str) -> None:
    body = data[header.size :]
    order = _ORDERS.get(header.format)
    queue = _Text(body) if order is None else _Binary(body, order)
    for element in header.elements:
        for row in range(element.count if element.properties else 0):
            try:
                _read_row(element, queue)
            except (ValueError, OverflowError) as why:
                raise MeshError(
                    f"{name}: {element.name} {row}: expected numbers as in the header, found: {why}"
                ) from why


def _read_row(element: Element, queue: _Text | _Binary) -> None:
    take = queue.take
    if not any(column.count_code for column in element.properties):
        values = take("".join(column.code for column in element.properties))
        for column, value in zip(element.properties, values, strict=True):
            element.columns.setdefault(column.name, []).append(value)
        return
    for column in element.properties:
        if not column.count_code:
            element.columns.setdefault(column.name, []).append(take(column.code)[0])
            continue
        count = int(take(column.count_code)[0])
        if not 0 <= count <= queue.left:
            raise ValueError(f"a list of {count}")
        element.lists.setdefault(column.name, []).append(take(column.code * count))


def _materials(
    header: Header, name: str, folder: Folder, warnings: list[str]
) -> tuple[tuple[Material, ...], tuple[Texture, ...]]:
    """One material a texture file."""
    shelf = TextureShelf(warnings)
    files = header.textures or header.likely_textures
    materials = []
    for file in files:
        path = folder.find(file)
        texture = None if path is None else _image(path, folder, shelf, warnings)
        maps = {} if texture is None else {"base_color": TextureMap(texture)}
        stem = material_name(PurePath(file).stem, warnings)
        materials.append(Material(name=stem or "material", maps=maps))
        if path is None:
            warnings.append(f"{name}: image {file!r} not found")
    return tuple(materials), tuple(shelf.textures)


def _image(path: Path, folder: Folder, shelf: TextureShelf, warnings: list[str]) -> int | None:
    try:
        return shelf.add(path.name, folder.read(path), str(path))
    except MeshError as why:
        warnings.append(f"{why}: left out")
        return None


def _assembled(
    vertex: Element,
    face: Element,
    materials: tuple[Material, ...],
    textures: tuple[Texture, ...],
    warnings: list[str],
    name: str,
) -> TexturedMesh:
    positions = _positions(vertex, name)
    polygons = face.lists.get("vertex_indices") or face.lists.get("vertex_index") or []
    sizes = np.array([len(polygon) for polygon in polygons], dtype=np.int64)
    corners = _flat_indices(polygons, len(positions), name)
    uvs, corner_uvs = _uvs(vertex, face, corners, sizes, name, warnings)
    numbers = _face_materials(face, len(sizes), len(materials), name, warnings)
    if not materials or (numbers == len(materials)).any():
        materials = (*materials, Material())
    whole = sizes >= 3
    if not whole.all():
        warnings.append(f"{name}: left out {(~whole).sum()} face(s) of fewer than three corners")
        kept = np.repeat(whole, sizes)
        corners, corner_uvs = corners[kept], corner_uvs[kept]
        sizes, numbers = sizes[whole], numbers[whole]
    triangles, owner = triangulate(positions[corners], sizes)
    uvs, uv_faces = without_unusable(uvs, corner_uvs[triangles], name, warnings)
    mesh = TexturedMesh(
        positions=positions,
        faces=corners[triangles].astype(np.int32),
        uvs=uvs,
        uv_faces=uv_faces.astype(np.int32),
        face_materials=numbers[owner].astype(np.int32),
        materials=materials,
        textures=textures,
        warnings=tuple(warnings),
    )
    if not set(_NORMAL) <= set(vertex.columns):
        return mesh
    return with_creases(mesh, _columns(vertex, _NORMAL, name)[mesh.faces])


def _positions(vertex: Element, name: str) -> Float64Array:
    """(n, 3) finite numbers."""
    values = _columns(vertex, _XYZ, name)
    finite = np.isfinite(values).all(axis=1)
    if not finite.all():
        row = int(finite.argmin())
        raise MeshError(
            f"{name}: vertex {row}: expected finite {_XYZ}, found {values[row].tolist()}"
        )
    return values


def _columns(vertex: Element, names: tuple[str, ...], name: str) -> Float64Array:
    """(n, len(names)) numbers."""
    missing = [column for column in names if column not in vertex.columns]
    if missing and vertex.count:
        raise MeshError(f"{name}: expected vertex properties {names}, found none of {missing}")
    table = [vertex.columns.get(column, []) for column in names]
    values = np.array(table, dtype=np.float64).reshape(len(names), -1).T
    return np.ascontiguousarray(values)


def _flat_indices(polygons: Sequence[Sequence[float]], count: int, name: str) -> Int64Array:
    flat = np.array([index for polygon in polygons for index in polygon], dtype=np.float64)
    wrong = ~((flat >= 0) & (flat < count) & (flat == np.floor(flat)))
    if wrong.any():
        corner = int(wrong.argmax())
        ends = np.cumsum([len(polygon) for polygon in polygons])
        face = int(np.searchsorted(ends, corner, side="right"))
        raise MeshError(
            f"{name}: face {face}: expected vertex indices below {count}, found {flat[corner]:g}"
        )
    return flat.astype(np.int64)


def _uvs(
    vertex: Element,
    face: Element,
    corners: Int64Array,
    sizes: Int64Array,
    name: str,
    warnings: list[str],
) -> tuple[Float64Array, Int64Array]:
    """UVs and each corner's index: the faces' own where they have them, else the vertices'."""
    listed = face.lists.get("texcoord")
    if listed is not None:
        return _corner_uvs(listed, sizes, name, warnings)
    for names in _UV_NAMES:
        if set(names) <= set(vertex.columns):
            return _columns(vertex, names, name), corners
    return np.zeros((0, 2)), np.full(len(corners), -1)


def _corner_uvs(
    listed: Sequence[Sequence[float]], sizes: Int64Array, name: str, warnings: list[str]
) -> tuple[Float64Array, Int64Array]:
    """A face without as many UVs as corners has none."""
    lengths = np.array([len(values) for values in listed], dtype=np.int64)
    right = (lengths == 2 * sizes) & (lengths > 0)
    wrong = ~right & (lengths > 0)
    if wrong.any():
        face = int(wrong.argmax())
        warnings.append(
            f"{name}: face {face}: expected {2 * sizes[face]} texture coordinates, "
            f"found {lengths[face]}: left out those of {wrong.sum()} face(s)"
        )
    kept = (listed[face] for face in np.flatnonzero(right).tolist())
    flat = np.array([value for values in kept for value in values], dtype=np.float64)
    has_uv = np.repeat(right, sizes)
    return flat.reshape(-1, 2), np.where(has_uv, np.cumsum(has_uv) - 1, -1)


def _face_materials(
    face: Element, faces: int, materials: int, name: str, warnings: list[str]
) -> Int64Array:
    """MeshLab numbers the textures; -1 is none. A file without textures has material 0."""
    numbers = face.columns.get("texnumber")
    if numbers is None:
        return np.zeros(faces, dtype=np.int64)
    chosen = np.array(numbers, dtype=np.float64)
    known = chosen < max(materials, 1)
    if not known.all():
        warnings.append(
            f"{name}: face {int(known.argmin())}: expected a texnumber below {materials}, found "
            f"{chosen[known.argmin()]:g}: left out those of {(~known).sum()} face(s)"
        )
    return np.where(known & (chosen >= 0), chosen, materials).astype(np.int64)
