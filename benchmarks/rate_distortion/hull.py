"""The lower convex hull of a rate-distortion cloud: what a codec's best settings reach."""

from __future__ import annotations

from collections.abc import Sequence
from math import log

Pair = tuple[float, float]


def lower_hull(pairs: Sequence[Pair]) -> list[int]:
    """Indices of the (bytes, error) pairs on the lower-left hull, cheapest first.

    The hull is taken of the logarithms, as such curves are read; along it the error falls.
    """
    order = sorted(range(len(pairs)), key=lambda index: pairs[index])
    hull: list[int] = []
    for index in order:
        if hull and pairs[index][1] >= pairs[hull[-1]][1]:
            continue
        while len(hull) > 1 and not _below(pairs, hull[-2], hull[-1], index):
            hull.pop()
        hull.append(index)
    return hull


def _below(pairs: Sequence[Pair], first: int, middle: int, last: int) -> bool:
    places = (pairs[first], pairs[middle], pairs[last])
    (x0, y0), (x1, y1), (x2, y2) = ((log(x), log(y)) for x, y in places)
    return (y1 - y0) * (x2 - x0) < (y2 - y0) * (x1 - x0)
