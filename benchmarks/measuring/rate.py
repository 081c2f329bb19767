"""What a file takes besides its images."""

from __future__ import annotations

from nispcodec.format import inspect
from nispcodec.format.constants import TXTR


def geometry_bytes(data: bytes) -> int:
    """Bytes of a `.nisp` file without its textures, as they are stored in it."""
    textures = sum(each.stored_length for each in inspect(data) if each.code == TXTR)
    return len(data) - textures
