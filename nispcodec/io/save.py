"""Mesh files: `write_mesh` picks the writer by the path's suffix."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from nispcodec.core.arrays import Float32Array
from nispcodec.core.asset import Material, Texture, TexturedMesh
from nispcodec.core.atomic_write import write_atomic
from nispcodec.core.errors import MeshError
from nispcodec.core.extras import require
from nispcodec.io.write.colors import untextured
from nispcodec.io.write.glb import glb_bytes
from nispcodec.io.write.gltf import gltf_files
from nispcodec.io.write.gltf_compression import COMPRESSIONS
from nispcodec.io.write.images_beside import ImagesBeside
from nispcodec.io.write.losses import gltf_losses, obj_losses, ply_losses, stl_losses, usdz_losses
from nispcodec.io.write.obj import obj_files
from nispcodec.io.write.ply import ply_files
from nispcodec.io.write.stl import stl_bytes
from nispcodec.io.write.usdz import usdz_bytes

# OBJ and PLY name their images in lines of text.
_CONTROL = re.compile(r"[\x00-\x1f\x7f]")

Writer = Callable[[TexturedMesh, str, ImagesBeside, Float32Array | None], dict[str, bytes]]
"""Mesh, stem of the file name, images, colors (n, 4) or None -> file names and bytes."""


def _alone(
    suffix: str, write: Callable[[TexturedMesh, Float32Array | None], bytes]
) -> dict[str, Writer]:
    """The writer of a format that is one file."""
    return {suffix: lambda mesh, stem, images, colors: {f"{stem}{suffix}": write(mesh, colors)}}


COMPRESSING: dict[str, Callable[..., dict[str, bytes]]] = {
    ".glb": lambda mesh, stem, images, *how: {f"{stem}.glb": glb_bytes(mesh, *how)},
    ".gltf": gltf_files,
}
"""Writers that take a compression as well."""
WRITERS: dict[str, Writer] = {
    **COMPRESSING,
    ".ply": ply_files,
    **_alone(".stl", stl_bytes),
    ".obj": obj_files,
    **_alone(".usdz", usdz_bytes),
}
SUFFIXES = tuple(WRITERS)
"""A new format is a file in `io/write` and a line here."""

# What each format leaves out of a mesh.
LOSSES: dict[str, Callable[[TexturedMesh], Iterable[str]]] = {
    ".glb": gltf_losses,
    ".gltf": gltf_losses,
    ".ply": ply_losses,
    ".stl": stl_losses,
    ".obj": obj_losses,
    ".usdz": usdz_losses,
}


def losses(mesh: TexturedMesh, path: str | Path) -> tuple[str, ...]:
    """The sentences that say what `write_mesh` leaves out of a mesh for this path.

    None for a suffix that is not written. Colors in place of textures are no loss.
    """
    find = LOSSES.get(Path(path).suffix.lower())
    return tuple(f"{path}: left out {what}" for what in find(mesh)) if find else ()


def write_mesh(
    mesh: TexturedMesh,
    path: str | Path,
    colors: Float32Array | None = None,
    compress: str | None = None,
    finer: Path | None = None,
) -> list[Path]:
    """Write the mesh in the format of the path's suffix -> the files written, `path` last.

    A glTF has its buffer and images beside it, an OBJ its MTL and images, a PLY its images; what a
    format cannot hold is left out (`losses`). Each file is written whole or not at all. `colors`
    (n, 4), sRGB-encoded in [0, 1], one for each position, take the place of UVs, materials and
    textures. `compress`, one of `COMPRESSIONS`, makes glTF smaller. `finer` is where the same mesh
    with more triangles was written: its images are shared, and not among the files. Raises
    MeshError for an unknown suffix, no faces, colors or a compression that do not fit or that the
    format cannot hold; NispError when writing fails, and without the package that compresses.
    """
    path = Path(path)
    expect_compressible(path, compress)
    if not len(mesh.faces):
        raise MeshError(f"{path}: expected a mesh with faces, found none")
    written = []
    if colors is not None:
        mesh = untextured(mesh, colors)
    for name, data in _files(mesh, path, colors, finer, compress).items():
        written.append(path.with_name(name))
        write_atomic(written[-1], data)
    return written


def expect_compressible(path: Path, compress: str | None) -> None:
    """Raises MeshError for a compression that there is none of, or that the format cannot hold.

    NispError without the package that it needs.
    """
    if compress is None:
        return
    if compress not in COMPRESSIONS:
        raise MeshError(f"compress: expected one of {', '.join(COMPRESSIONS)}, found {compress!r}")
    if path.suffix.lower() not in COMPRESSING:
        raise MeshError(f"{path}: expected .glb or .gltf for the compression {compress}")
    if compress == "draco":
        require("DracoPy", extra="gltf", what_for="compressing by draco")
    if compress == "meshopt":
        require("meshoptimizer", extra="gltf", what_for="compressing by meshopt")


def mesh_paths(
    path: Path,
    materials: Sequence[Material],
    textures: Sequence[Texture],
    colored: bool = False,
    finer: Path | None = None,
) -> list[Path]:
    """The files that `write_mesh` writes for any mesh of these materials and textures.

    `colored` is for a mesh that is written with colors, `finer` as there. Raises MeshError as
    `write_mesh` does, for a suffix, and for colors in a format that holds none.
    """
    # USD's packager takes no empty files.
    names = tuple(replace(each, data=b"-", mime="image/png") for each in textures)
    mesh = replace(_triangle(), materials=tuple(materials), textures=names)
    colors = np.ones((3, 4), np.float32) if colored else None
    if colors is not None:
        mesh = untextured(mesh, colors)
    return [path.with_name(name) for name in _files(mesh, path, colors, finer)]


def level_paths(path: Path, levels: int) -> list[Path]:
    """Where levels of detail go: out.glb, then out.lod1.glb, out.lod2.glb, ..."""
    others = [path.with_name(f"{path.stem}.lod{k}{path.suffix}") for k in range(1, levels)]
    return [path, *others]


def _triangle() -> TexturedMesh:
    """The smallest mesh with UVs."""
    corners = np.arange(3, dtype=np.int32)[None]
    plain = TexturedMesh.geometry_only(np.eye(3), corners, "")
    return replace(plain, uvs=np.eye(3)[:, :2], uv_faces=corners)


def _files(
    mesh: TexturedMesh,
    path: Path,
    colors: Float32Array | None,
    finer: Path | None,
    compress: str | None = None,
) -> dict[str, bytes]:
    """File names and bytes, that of `path` last."""
    suffix = path.suffix.lower()
    if suffix not in WRITERS:
        found = repr(path.suffix) if path.suffix else "none"
        raise MeshError(f"{path}: expected a suffix of {', '.join(SUFFIXES)}, found {found}")
    if "\0" in str(path) or _CONTROL.search(path.name):
        raise MeshError(f"{str(path)!r}: expected a name without control characters")
    images = ImagesBeside.of(mesh, (finer or path).stem, shared=finer is not None)
    if compress:
        files = COMPRESSING[suffix](mesh, path.stem, images, colors, compress)
    else:
        files = WRITERS[suffix](mesh, path.stem, images, colors)
    files[path.name] = files.pop(f"{path.stem}{suffix}")
    return files
