"""Names of files and materials in text formats: nothing that ends a word or a path, none twice."""

from __future__ import annotations

import re
from collections.abc import Sequence

from nispcodec.core.asset import Texture


def image_names(stem: str, textures: Sequence[Texture]) -> list[str]:
    """A file name for each texture, named after the output, so that no other file is touched.

    AVIF, which is written as PNG, is named so.
    """
    # Before they are told apart: a.avif is not to take the place of a.png.
    return [f"{stem}_{name}" for name in unique([_as_png(plain(each.name)) for each in textures])]


def plain(name: str) -> str:
    """The name with nothing that ends a word or a path in an OBJ, MTL or PLY file."""
    return re.sub(r"[^\w.-]+", "_", name).lstrip(".") or "unnamed"


def _as_png(name: str) -> str:
    return re.sub(r"\.avif$", ".png", name, flags=re.IGNORECASE)


def unique(names: Sequence[str]) -> list[str]:
    """Equal names told apart (also where upper and lower case are one) by a number in front."""
    seen: set[str] = set()
    result = []
    for name in names:
        candidate, number = name, 2
        while candidate.lower() in seen:
            candidate, number = f"{number}_{name}", number + 1
        seen.add(candidate.lower())
        result.append(candidate)
    return result
