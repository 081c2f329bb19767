"""Seams and creases: a flag for each edge."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import BoolArray
from nispcodec.format.mesh import slots
from nispcodec.format.mesh.binary_coder import BinaryCoder
from nispcodec.format.mesh.connectivity import Surface
from nispcodec.format.mesh.fields import flag
from nispcodec.format.mesh.numbers import shortened
from nispcodec.format.mesh.positions import Vector
from nispcodec.format.mesh.surface import Given

FINE = 10


def bends(corners: list[int], twin: list[int], places: list[Vector]) -> list[int]:
    """How sharp each edge is, of each side: 0 to 8 from right angles to flat, 9 at borders."""
    normals = [_normal(*(places[v] for v in corners[at : at + 3])) for at in range(0, len(twin), 3)]
    found = []
    for side, other in enumerate(twin):
        if other < 0:
            found.append(9)
            continue
        m, n = normals[side // 3], normals[other // 3]
        dot = m[0] * n[0] + m[1] * n[1] + m[2] * n[2]
        both = m[3] * n[3]
        found.append(8 * dot * dot // both if dot > 0 and both else 0)
    return found


def _normal(a: Vector, b: Vector, c: Vector) -> tuple[int, int, int, int]:
    u = shortened([b[i] - a[i] for i in range(3)], FINE)
    v = shortened([c[i] - a[i] for i in range(3)], FINE)
    x, y, z = shortened(
        [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]], FINE
    )
    return x, y, z, x * x + y * y + z * z


def code(
    coder: BinaryCoder,
    surface: Surface,
    corners: list[int],
    places: list[Vector],
    given: Given | None,
) -> tuple[BoolArray, BoolArray]:
    """(3 m,) seams and creases: both sides of an edge have the same flag, borders are seams."""
    sharp = bends(corners, surface.twin, places)
    border = np.array(surface.twin) < 0
    some = given is not None and bool((given.seams() > border).any())
    seams = border.tolist()
    if flag(coder, some, slots.HAS_SEAMS):
        _code(coder, slots.SEAM, surface, sharp, seams, given.seams().tolist() if given else None)
    some = given is not None and bool(given.creases().any())
    creases = [False] * len(seams)
    if flag(coder, some, slots.HAS_CREASES):
        wanted = given.creases().tolist() if given else None
        for side in np.flatnonzero(border).tolist():
            crease = wanted is not None and wanted[side]
            creases[side] = bool(coder.bit(crease, slots.BORDER_CREASE, 0, 0, 0))
        _code(coder, slots.CREASE, surface, sharp, creases, wanted)
    return np.array(seams), np.array(creases)


def _code(
    coder: BinaryCoder,
    slot: int,
    surface: Surface,
    sharp: list[int],
    flags: list[bool],
    given: list[bool] | None,
) -> None:
    """Sets the flags of all sides but borders."""
    corners, twin = surface.corners, surface.twin
    lines, left = _ends(surface, flags)
    for side, other in enumerate(twin):
        if other <= side:
            continue
        ends = corners[side], corners[side - side % 3 + (side + 1) % 3]
        states = sorted(min(lines[end], 3) * 4 + min(left[end], 4) - 1 for end in ends)
        lined = states[0] * 16 + states[1]
        few = (states[0] >> 2) * 4 + (states[1] >> 2)
        wanted = given is not None and given[side]
        bit = coder.bit(wanted, slot, lined, lined * 10 + sharp[side], few * 10 + sharp[side])
        for end in ends:
            left[end] -= 1
            lines[end] += bit
        flags[side] = flags[other] = bool(bit)


def _ends(surface: Surface, flags: list[bool]) -> tuple[list[int], list[int]]:
    """How many edges with a flag end at each point, and how many whose flags are to come."""
    lines, left = [0] * surface.points, [0] * surface.points
    for side, other in enumerate(surface.twin):
        for end in (surface.corners[side], surface.corners[side - side % 3 + (side + 1) % 3]):
            lines[end] += other < 0 and flags[side]
            left[end] += other > side
    return lines, left
