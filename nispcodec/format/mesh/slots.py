"""Which decision has which slot of the coder: numbers of the format."""

from __future__ import annotations

NEW, RIGHT, LEFT, SPLIT, BORDER, PAIR, FAR, BACK = range(8)
HAS_COPIES, IS_COPY, SHEET, HAS_SEAMS, SEAM, HAS_CREASES, CREASE, BORDER_CREASE = range(8, 16)
HAS_UV, MEMBER, ONE_PLACE, MIRRORED, HAS_MATERIALS = range(16, 21)
FLIP, DOWN, SEEN, BESIDE, STACKED = range(21, 26)
# Of numbers, two slots each.
STEP, ORIGIN, UV_STEP, UV_ORIGIN, ROTATION, OFFSET, SCALE, UV_SCALE, UV_OFFSET = range(32, 50, 2)
# Of integers, 64 slots each.
STEPS, RANK, POSITION, NORMAL, POSITION_START, UV, UV_START, UV_SECOND, UV_THIRD = range(
    64, 640, 64
)
