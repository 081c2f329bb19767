"""Probabilities and their logarithmic odds, in integers: what the models of a mesh are mixed in.

A probability is a number of 65536ths; its *stretch* is ln(p / (1 - p)) in 256ths, from -2047 to
2047 (Mahoney, "Adaptive Weighing of Context Models for Lossless Data Compression", 2005).
"""

from __future__ import annotations

# 65536 / (1 + exp(-x / 256)) at x = -2048, -1920, ... 2048.
_KNOTS = (
    22, 36, 60, 98, 162, 267, 439, 720, 1179, 1921, 3108, 4972, 7812, 11955, 17625, 24743, 32768,
    40793, 47911, 53581, 57724, 60564, 62428, 63615, 64357, 64816, 65097, 65269, 65374, 65438,
    65476, 65500, 65514,
)  # fmt: skip


def squash(stretched: int) -> int:
    """The probability of logarithmic odds: straight lines between the knots."""
    place = min(max(stretched, -2047), 2047) + 2048
    low, high = _KNOTS[place >> 7], _KNOTS[(place >> 7) + 1]
    return (low * (128 - (place & 127)) + high * (place & 127) + 64) >> 7


def _inverse() -> tuple[int, ...]:
    """For each probability in 4096ths the lowest stretch whose squash is not below it."""
    table, stretched = [], -2047
    for probability in range(4096):
        while stretched < 2047 and squash(stretched) >> 4 < probability:
            stretched += 1
        table.append(stretched)
    return tuple(table)


SQUASH = tuple(squash(stretched) for stretched in range(-2048, 2048))
STRETCH = _inverse()
