"""Points that are one vertex: where sheets meet in an edge, or bodies in a corner."""

from __future__ import annotations

from nispcodec.format.mesh import slots
from nispcodec.format.mesh.binary_coder import BinaryCoder
from nispcodec.format.mesh.fields import flag


def code(coder: BinaryCoder, points: int, given: list[int] | None) -> list[int]:
    """The vertex of each point; vertices are numbered by their first points.

    given: for each point any number that is the same for points of one vertex.
    """
    numbers: dict[int, int] = {}
    wanted = [numbers.setdefault(vertex, len(numbers)) for vertex in given or ()]
    if not flag(coder, given is not None and len(numbers) < points, slots.HAS_COPIES):
        return list(range(points))
    found: list[int] = []
    count = last = 0
    for point in range(points):
        vertex = wanted[point] if given is not None else 0
        last = coder.bit(vertex < count, slots.IS_COPY, last, last, last)
        if last:
            found.append(coder.below(vertex, count, "copy"))
        else:
            found.append(count)
            count += 1
    return found
