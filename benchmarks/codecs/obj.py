"""OBJ text: the file as it is, and with nothing but positions and UVs in fewer digits."""

from __future__ import annotations

from math import ceil, log10

import numpy as np

from benchmarks.assets.source import Source
from benchmarks.codecs import Setting
from benchmarks.codecs.glb import with_materials
from nispcodec.core.arrays import AnyArray
from nispcodec.core.asset import TexturedMesh
from nispcodec.io.folder import Folder
from nispcodec.io.read.obj import read_obj

AS_IS = "as it is"


def settings(source: Source, quick: bool) -> list[Setting]:
    """The file itself, or digits after the point of positions (in radii) and of UVs."""
    digits = (4,) if quick else (5, 4, 3)
    texts = [AS_IS, *(f"{count} digits" for count in digits)]
    return [{"text": text} for text in texts]


def encode(source: Source, setting: Setting) -> bytes:
    """Text."""
    if setting["text"] == AS_IS:
        return source.path.read_bytes()
    return text_of(source, int(str(setting["text"]).split()[0]))


def text_of(source: Source, digits: int) -> bytes:
    """Positions and UVs alone; materials by name."""
    mesh = source.mesh
    coarse = max(0, digits - ceil(log10(source.reference.frame.radius)))
    parts = [_rows("v" + f" %.{coarse}f" * 3 + "\n", mesh.positions)]
    parts.append(_rows("vt" + f" %.{digits}f" * 2 + "\n", mesh.uvs))
    for index in np.unique(mesh.face_materials).tolist():
        parts.append(f"usemtl {mesh.materials[index].name}\n")
        chosen = mesh.face_materials == index
        both = np.stack([mesh.faces, mesh.uv_faces], axis=2) + 1
        parts.append(_rows("f %d/%d %d/%d %d/%d\n", both[chosen & mesh.has_uv]))
        parts.append(_rows("f %d %d %d\n", mesh.faces[chosen & ~mesh.has_uv] + 1))
    return "".join(parts).encode()


def decode(data: bytes, source: Source) -> TexturedMesh:
    """Our own reader."""
    return with_materials(read_obj(data, source.path.name, Folder(source.path.parent)), source)


def _rows(pattern: str, values: AnyArray) -> str:
    return (pattern * len(values)) % tuple(values.ravel().tolist())
