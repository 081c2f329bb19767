"""Names as every format of ours holds them."""

from __future__ import annotations

import re

# Control characters, and halves of surrogate pairs, which are no text.
_UNPRINTABLE = re.compile(r"[\x00-\x1f\x7f\ud800-\udfff]")


def material_name(name: str, warnings: list[str]) -> str:
    """The name with "_" for what is a command or no text elsewhere, said in a new warning."""
    clean = _UNPRINTABLE.sub("_", name)
    if clean != name:
        warnings.append(f"material {name!r}: control characters in its name became '_'")
    return clean
