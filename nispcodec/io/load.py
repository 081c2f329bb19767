"""Read an asset from disk: one entry for every mesh format."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from nispcodec.core.asset import TexturedMesh
from nispcodec.core.errors import MeshError
from nispcodec.io.cleanup import clean
from nispcodec.io.folder import Folder
from nispcodec.io.outliers import with_outliers_named
from nispcodec.io.read.gltf import read_gltf
from nispcodec.io.read.obj import read_obj
from nispcodec.io.read.off import read_off
from nispcodec.io.read.ply import read_ply
from nispcodec.io.read.stl import read_stl

# A reader takes the file's bytes, its name for messages, and the folder that it may refer to.
Reader = Callable[[bytes, str, Folder], TexturedMesh]

READERS: dict[str, Reader] = {
    ".obj": read_obj,
    ".gltf": read_gltf,
    ".glb": read_gltf,
    ".ply": read_ply,
    ".stl": read_stl,
    ".off": read_off,
}


def load_mesh(path: str | Path) -> TexturedMesh:
    """Read OBJ, glTF, GLB, PLY, STL or OFF with its materials and textures, cleaned up.

    Positions are in the world frame, in the file's units; UVs have their origin bottom-left.
    `warnings` of the mesh say what was left out or guessed. Raises MeshError, naming the file and
    the place in it, for whatever cannot be read.
    """
    path = Path(path)
    reader_of(path)
    return parse_mesh(_read(path), path, Folder(path.parent))


def parse_mesh(data: bytes, path: Path, folder: Folder) -> TexturedMesh:
    """The mesh in the bytes of a file, as `load_mesh` gives it; `folder` finds what it names.

    Raises MeshError as `load_mesh` does.
    """
    reader = reader_of(path)
    if not data:
        raise MeshError(f"{path}: expected a mesh, found an empty file")
    mesh = clean(reader(data, path.name, folder), path.name)
    return replace(with_outliers_named(mesh), name=path.stem)


def reader_of(path: Path) -> Reader:
    """The reader for a file's suffix. Raises MeshError, naming all suffixes, for another one."""
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise MeshError(f"{path}: expected one of {' '.join(READERS)}, found {path.suffix!r}")
    return reader


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except (OSError, ValueError) as why:
        raise MeshError(f"{path}: cannot be read: {why}") from why
