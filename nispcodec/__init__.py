"""Neural codec for textured 3D assets.

model = nispcodec.encode(mesh)          a TexturedMesh to a NispModel (needs torch)
nispcodec.save(model, "asset.nisp")
model = nispcodec.load("asset.nisp")    queries and meshes need numpy alone
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from nispcodec.asset import Material, Texture, TexturedMesh, TextureMap
from nispcodec.encoder import EncodeConfig, encode
from nispcodec.errors import FitError, FormatError, MeshError, NispError, QueryError
from nispcodec.progress import Progress

if TYPE_CHECKING:
    from nispcodec.decode.model import NispModel

__all__ = [
    "EncodeConfig",
    "FitError",
    "FormatError",
    "Material",
    "MeshError",
    "NispError",
    "NispModel",
    "Progress",
    "QueryError",
    "Texture",
    "TextureMap",
    "TexturedMesh",
    "encode",
    "load",
    "save",
]

__version__ = "0.1.0"


def load(path: str | Path) -> NispModel:
    """Read a `.nisp` file. Raises FormatError for a malformed one, NispError if unreadable."""
    from nispcodec.decode.model import NispModel
    from nispcodec.format import read

    return NispModel(read(path))


def save(model: NispModel, path: str | Path) -> None:
    """Write a `.nisp` file: whole, or not at all."""
    from nispcodec.format import pack
    from nispcodec.output import write_atomic

    write_atomic(Path(path), pack(model.document))


def __getattr__(name: str) -> object:
    if name == "NispModel":
        from nispcodec.decode.model import NispModel

        return NispModel
    raise AttributeError(f"module 'nispcodec' has no attribute {name!r}")
