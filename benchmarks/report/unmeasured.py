"""What was asked for in numbers and no committed result has: a command is wanted for each."""

from __future__ import annotations

UNMEASURED: tuple[tuple[str, str], ...] = (
    ("assets held as fields and triangles both, 10 % smaller than either alone", ">= 2"),
    (
        "spot, chess_king, tea_set_01, food_apple_01 as fields: bytes at equal error, new / old",
        "<= 1",
    ),
)
