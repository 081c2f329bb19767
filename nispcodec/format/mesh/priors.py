"""How likely a 1 is in each slot before anything is known, in 256ths.

Means over simplified meshes of eleven assets, 64 to 1600 faces; in slots that are not here 128.
"""

from __future__ import annotations

from nispcodec.format.mesh import slots

UP, DOWN = 2, 20

SINGLE = {
    slots.RIGHT: 62,
    slots.LEFT: 217,
    slots.PAIR: 231,
    slots.FAR: 11,
    slots.IS_COPY: 9,
    slots.SEAM: 63,
    slots.BESIDE: 151,
    slots.SEEN: 48,
}
"""Single decisions."""

NUMBERS = {
    slots.STEPS: ((254, 252, 66, 54, 21, 8), ()),
    slots.RANK: ((44, 34, 6), ()),
    slots.POSITION: (
        (132, 129, 80, 74, 91, 101, 126, 104, 94, 67, 21),
        (138, 127, 126, 121, 133, 152, 184, 207),
    ),
    slots.NORMAL: (
        (171, 178, 138, 107, 99, 88, 91, 64, 78, 111, 166, 21),
        (142, 137, 144, 162, 171, 207, 18),
    ),
    slots.POSITION_START: ((12, 10, 10), (223, 215, 201, 178, 179, 176, 188, 162, 214, 133)),
    slots.UV: ((92, 125, 104, 74, 42, 72, 82, 37, 21), (179, 160, 148, 150, 161)),
    slots.UV_START: ((144, 177, 120, 2), (169, 158, 161, 144, 164, 157, 138)),
    slots.UV_SECOND: ((32, 52, 56, 25, 235, 21), (150, 170, 184, 181, 208, 212, 239, 250, 219)),
    slots.UV_THIRD: ((155, 160, 100, 56, 50, 70, 92, 235, 128, 37), (155, 160, 190, 236, 188, 243)),
}
"""Integers: whether they are longer than expected, and longer still; whether shorter."""


SURE = 4
"""How many bits a share stands for."""


def table() -> dict[int, tuple[int, int]]:
    """For each slot the probability of a 1, in 65536ths, and how many bits it stands for."""
    found = dict(SINGLE)
    for slot, (longer, shorter) in NUMBERS.items():
        found |= {slot + UP + step: share for step, share in enumerate(longer)}
        found |= {slot + DOWN + step: share for step, share in enumerate(shorter)}
    return {slot: (share << 8, SURE) for slot, share in found.items()}
