"""Images as KTX2 by Basis Universal, which is what `gltfpack -tc` calls, and back.

The build of gltfpack in npm has no textures. Here by `pip install alktx2==0.1.7`, without mipmaps.
"""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec
from typing import Any

from benchmarks.codecs import Unavailable
from nispcodec.core.asset import Texture

VERSION = "0.1.7"
BLOCKS = ("etc1s", "uastc")


def encode(image: Texture, blocks: str, quality: int, is_data: bool) -> bytes:
    """A KTX2 file; `blocks` is one of BLOCKS, `quality` 1 to 100, of colors or of data."""
    made: bytes = _library().encode_bytes_to_ktx2(
        image.data,
        mime=image.mime,
        codec=blocks,
        quality=quality,
        srgb=not is_data,
        linear=is_data,
        zstd_supercompression_level=19 if blocks == "uastc" else None,
    )
    return made


def decode(data: bytes, name: str) -> Texture:
    """The image in a KTX2 file, as PNG."""
    pixels, mime = _library().decode_ktx2_to_bytes(data, format="png")
    return Texture(name, pixels, mime)


def _library() -> Any:
    if find_spec("alktx2") is None:
        raise Unavailable(f"alktx2 is not installed: pip install alktx2=={VERSION}")
    return import_module("alktx2")
