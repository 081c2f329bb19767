"""Neural codec for textured 3D assets.

model = nispcodec.encode(mesh)          a TexturedMesh to a NispModel (needs torch)
nispcodec.save(model, "asset.nisp")
model = nispcodec.load("asset.nisp")    queries and meshes need numpy alone
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from nispcodec.core.asset import Material, Texture, TexturedMesh, TextureMap
from nispcodec.core.errors import FitError, FormatError, MeshError, NispError, QueryError
from nispcodec.core.progress import Listener, Progress, silent
from nispcodec.encode.config import EncodeConfig

if TYPE_CHECKING:
    from nispcodec.encode.config import Tuning
    from nispcodec.model import NispModel

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


def encode(
    mesh: TexturedMesh,
    config: EncodeConfig | None = None,
    progress: Listener = silent,
    tuning: Tuning | None = None,
) -> NispModel:
    """Fit networks to an asset; see `nispcodec.encode.recipe.encode`."""
    from nispcodec.encode import recipe

    return recipe.encode(mesh, config, progress, tuning)


def load(path: str | Path) -> NispModel:
    """Read a `.nisp` file. Raises FormatError for a malformed one, NispError if unreadable."""
    from nispcodec.format import read
    from nispcodec.model import NispModel

    return NispModel(read(path))


def save(model: NispModel, path: str | Path) -> None:
    """Write a `.nisp` file: whole, or not at all."""
    from nispcodec.core.atomic_write import write_atomic
    from nispcodec.format import pack

    write_atomic(Path(path), pack(model.document))


def __getattr__(name: str) -> object:
    if name == "NispModel":
        from nispcodec.model import NispModel

        return NispModel
    raise AttributeError(f"module 'nispcodec' has no attribute {name!r}")
