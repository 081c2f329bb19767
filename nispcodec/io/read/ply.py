"""PLY: polygons in text or binary, with a UV for each vertex or corner, and textures by name."""

from __future__ import annotations

import re
from collections.abc import Container, Iterator, Sequence
from pathlib import Path, PurePath

import numpy as np

from nispcodec.core.arrays import Float64Array, Int64Array
from nispcodec.core.asset import Material, Texture, TexturedMesh, TextureMap
from nispcodec.core.counted import counted
from nispcodec.core.errors import MeshError
from nispcodec.io.folder import Folder
from nispcodec.io.images import TextureShelf
from nispcodec.io.read import wavefront
from nispcodec.io.read.coordinates import without_unusable, without_unused
from nispcodec.io.read.names import material_name
from nispcodec.io.read.normals import with_creases
from nispcodec.io.read.ply_tables import Element, Header, parse_header, read_elements
from nispcodec.io.read.polygons import triangulate

# As MeshLab, Blender, VTK and Assimp have them, and others.
_UV_NAMES = (
    ("s", "t"), ("u", "v"), ("texture_u", "texture_v"), ("texture_s", "texture_t"),
    ("s0", "t0"), ("u0", "v0"), ("tu", "tv"), ("tx", "ty"),
)  # fmt: skip
_UV_LISTS = ("texcoord", "texcoords", "texture_coords", "uv")
# The list of a face's corners.
_CORNERS = ("vertex_indices", "vertex_index", "vertex_indexes")
_XYZ = ("x", "y", "z")
_NORMAL = ("nx", "ny", "nz")
_COLORS = {"red", "diffuse_red", "ambient_red", "r"}
_CHANNEL = re.compile(r"(\w+_)?(red|green|blue|alpha)|[rgba]")


def read_ply(data: bytes, name: str, folder: Folder) -> TexturedMesh:
    """Parse a PLY file, and the images in `folder` that its comments name.

    Raises MeshError, naming the file `name` and the place in it, for a malformed file.
    """
    data = data.removeprefix(wavefront.BYTE_ORDER_MARK)
    header = parse_header(data, name)
    after = read_elements(header, data, name)
    elements = {element.name: element for element in header.elements}
    vertex, face = elements.get("vertex"), elements.get("face")
    warnings = [f"{place}: left out a line of the header" for place in header.unknown]
    warnings.extend(after)
    has_strips = "tristrips" in elements and (face is None or not face.count)
    if has_strips:
        face = _without_strips(elements["tristrips"], name)
    if vertex is None or face is None:
        raise MeshError(f"{name}: expected elements vertex and face, found {list(elements)}")
    used = {"vertex", "tristrips" if has_strips else "face"}
    others = [each.name for each in header.elements if each.count and each.name not in used]
    warnings.extend(f"{name}: left out element {other!r}" for other in others)
    for element in (vertex, face):
        warnings.extend(_unread(element, _read_names(element, face), name))
    materials, textures = _materials(header, name, folder, warnings)
    return _assembled(vertex, face, materials, textures, warnings, name)


def _corner_lists(table: Element, name: str) -> list[Sequence[float]]:
    """The vertex indices of each face or strip."""
    known = _first(_CORNERS, table.lists)
    if not known and table.count:
        raise MeshError(
            f"{name}: expected a list of vertex indices in element {table.name}, one of "
            f"{', '.join(_CORNERS)}, found {', '.join(table.lists) or 'no list'}"
        )
    return table.lists[known[0]] if known else []


def _without_strips(strips: Element, name: str) -> Element:
    """Strips, with -1 between them, as faces: every second triangle is the other way round."""
    listed = _corner_lists(strips, name)
    flat = np.array([index for strip in listed for index in (*strip, -1)], dtype=np.float64)
    place = np.arange(len(flat))
    since = place - np.maximum.accumulate(np.where(flat < 0, place + 1, 0))
    first = np.flatnonzero((since[2:] >= 2) & (flat[2:] >= 0))
    odd = since[first + 2] % 2
    faces = flat[np.stack([first, first + 1 + odd, first + 2 - odd], axis=1)]
    others = [each for each in strips.properties if each.name not in _CORNERS]
    return Element(strips.name, len(faces), others, lists={"vertex_indices": faces.tolist()})


def _read_names(element: Element, face: Element) -> set[str]:
    """The properties of the vertices or the faces that a mesh is made of."""
    if element is face:
        number = _first(("texnumber",), face.columns)
        return {*_first(_CORNERS, face.lists), *_first(_UV_LISTS, face.lists), *number}
    normal = _NORMAL if set(_NORMAL) <= element.columns.keys() else ()
    uvs = () if _first(_UV_LISTS, face.lists) else _uv_names(element)
    number = () if "texnumber" in face.columns else ("texnumber",)
    return {*_XYZ, *normal, *uvs, *number}


def _unread(element: Element, read: set[str], name: str) -> Iterator[str]:
    """Warnings of the other properties; those of colors are told as one thing."""
    others = [each.name for each in element.properties if each.name not in read]
    if _COLORS & element.columns.keys():
        yield f"{name}: left out {element.name} colors"
        others = [each for each in others if not _CHANNEL.fullmatch(each)]
    if others:
        kind = "property" if len(others) == 1 else "properties"
        yield f"{name}: left out {element.name} {kind} {', '.join(map(repr, others))}"


def _first(names: tuple[str, ...], lists: Container[str]) -> tuple[str, ...]:
    """The first of the names that is there, alone; none where none is."""
    return tuple(each for each in names if each in lists)[:1]


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
    polygons = _corner_lists(face, name)
    sizes = np.array([len(polygon) for polygon in polygons], dtype=np.int64)
    corners = _flat_indices(polygons, vertex.count, name)
    positions = _positions(vertex, corners, name, warnings)
    uvs, corner_uvs = _uvs(vertex, face, corners, sizes, name, warnings)
    texnumbers = _texnumbers(vertex, face, corners, sizes, name, warnings)
    numbers = _face_materials(texnumbers, len(materials), name, warnings)
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
    shown = np.unique(numbers[owner[(uv_faces >= 0).all(axis=1)]])
    warnings.extend(_hidden_images(materials, textures, shown.tolist(), name))
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


def _positions(
    vertex: Element, corners: Int64Array, name: str, warnings: list[str]
) -> Float64Array:
    """(n, 3) finite numbers."""
    values = without_unused(_columns(vertex, _XYZ, name), corners, name, warnings)
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
    for listed in _first(_UV_LISTS, face.lists):
        return _corner_uvs(face.lists[listed], sizes, name, warnings)
    names = _uv_names(vertex)
    if names:
        return _columns(vertex, names, name), corners
    return np.zeros((0, 2)), np.full(len(corners), -1)


def _uv_names(vertex: Element) -> tuple[str, ...]:
    """The columns of the vertices' UVs, none where there are none."""
    for names in _UV_NAMES:
        is_tangent = "tx" in names and "tz" in vertex.columns
        if set(names) <= vertex.columns.keys() and not is_tangent:
            return names
    return ()


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


def _texnumbers(
    vertex: Element,
    face: Element,
    corners: Int64Array,
    sizes: Int64Array,
    name: str,
    warnings: list[str],
) -> Float64Array:
    """Which image each face shows, the first where nothing says it: as MeshLab numbers them.

    Vertices may say it in place of their faces, which go by their first corner.
    """
    if "texnumber" in face.columns:
        return np.array(face.columns["texnumber"], dtype=np.float64)
    if "texnumber" not in vertex.columns:
        return np.zeros(len(sizes))
    by_corner = np.array(vertex.columns["texnumber"], dtype=np.float64)[corners]
    ends = np.cumsum(sizes)
    by_face = np.append(by_corner, -1)[np.minimum(ends - sizes, len(corners))]
    owner = np.repeat(np.arange(len(sizes)), sizes)
    mixed = np.unique(owner[by_corner != by_face[owner]])
    if mixed.size:
        warnings.append(
            f"{name}: face {mixed[0]}: expected one texnumber of all its vertices, found several: "
            f"{counted(mixed.size, 'face')} as their first vertex"
        )
    return by_face


def _face_materials(
    texnumbers: Float64Array, materials: int, name: str, warnings: list[str]
) -> Int64Array:
    """The material of each face: -1 is none. A file without textures has material 0."""
    known = texnumbers < max(materials, 1)
    if not known.all():
        warnings.append(
            f"{name}: face {int(known.argmin())}: expected a texnumber below {materials}, found "
            f"{texnumbers[known.argmin()]:g}: left out those of {(~known).sum()} face(s)"
        )
    return np.where(known & (texnumbers >= 0), texnumbers, materials).astype(np.int64)


def _hidden_images(
    materials: tuple[Material, ...], textures: tuple[Texture, ...], shown: list[int], name: str
) -> Iterator[str]:
    """Warnings of the images that no face shows, `shown` being the materials of faces with UVs."""
    maps = [materials[each].maps.get("base_color") for each in shown]
    used = {each.texture for each in maps if each is not None}
    why = "with texture coordinates has its texnumber" if shown else "has texture coordinates"
    for place, texture in enumerate(textures):
        if place not in used:
            yield f"{name}: left out image {texture.name!r}: no face {why}"
