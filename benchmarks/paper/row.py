"""One published number beside ours."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Comparison:
    """`published` and `ours` in `unit`; `differs`: what is not the same between the two."""

    table: str
    quantity: str
    published: float
    ours: float
    unit: str
    differs: str
