"""`.nisp` among the formats of `trimesh.load`."""

from __future__ import annotations

from typing import Any, BinaryIO

from trimesh.exchange import load

from nispcodec.core.document import Document
from nispcodec.core.errors import FormatError
from nispcodec.format import unpack
from nispcodec.io.write.trimesh_geometry import trimesh_arguments
from nispcodec.model import NispModel


def register() -> None:
    """Add the suffix to trimesh's table of loaders, which is all that trimesh has for plugins."""
    load.mesh_loaders["nisp"] = _load


def _load(
    file_obj: BinaryIO,
    file_type: str | None = None,
    resolver: object = None,
    metadata: dict[str, Any] | None = None,
    resolution: int | None = None,
    faces: int | None = None,
    error: float | None = None,
    keep_spurious: bool = False,
    **options: Any,
) -> dict[str, Any]:
    """What trimesh makes a scene of; `options` go to every mesh, as with its own formats."""
    model = NispModel(_document(file_obj))
    arguments = trimesh_arguments(model.to_mesh(resolution, faces, error, keep_spurious))
    geometry = {name: {**each, **options} for name, each in arguments.items()}
    return {"geometry": geometry, "metadata": metadata}


def _document(file: BinaryIO) -> Document:
    """Raises FormatError, naming the file where it has a name, for a malformed one."""
    try:
        return unpack(file.read())
    except FormatError as error:
        error.file = str(getattr(file, "name", ""))
        raise
