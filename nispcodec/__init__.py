"""Neural codec for textured 3D assets."""

from nispcodec.asset import Material, Texture, TexturedMesh, TextureMap
from nispcodec.errors import FitError, FormatError, MeshError, NispError, QueryError

__all__ = [
    "FitError",
    "FormatError",
    "Material",
    "MeshError",
    "NispError",
    "QueryError",
    "Texture",
    "TextureMap",
    "TexturedMesh",
]
