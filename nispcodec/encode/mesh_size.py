"""Triangles of at most so many bytes: the nearest that are found in a few trials."""

from __future__ import annotations

import math
from bisect import bisect_right

from nispcodec.core.mesh_part import MAX_GRID_BITS
from nispcodec.encode.config import FormConfig
from nispcodec.simplify.ladder import Candidate, Simplifier


def nearest_of_size(simplifier: Simplifier, most_bytes: float, config: FormConfig) -> Candidate:
    """The nearest candidate found of at most so many bytes; the smallest where none is.

    All faces on grids as fine as there is room for, else as many faces as there is room for.
    """
    whole = _whole(simplifier, most_bytes, config)
    if whole is not None:
        return whole
    return _coarser(simplifier, _most_faces(simplifier, most_bytes, config), most_bytes, config)


def fewest(simplifier: Simplifier) -> Candidate:
    """The candidate of the fewest faces that are made."""
    return simplifier.balanced(min(simplifier.config.fewest, len(simplifier.source.triangles)))


def _whole(simplifier: Simplifier, most_bytes: float, config: FormConfig) -> Candidate | None:
    """Every face on the finest grids whose bytes suffice; None where not even the coarsest do."""
    everything = len(simplifier.source.triangles)
    if everything * config.least_bytes_per_face > most_bytes:
        return None
    bits = simplifier.bits_for(config.negligible, whole=True)
    uv_bits = simplifier.uv_bits_for(config.negligible_uv)

    def made(more: tuple[int, int]) -> Candidate:
        finer = (bits + more[0], uv_bits + more[1])
        return simplifier.candidate(everything, *(min(max(1, b), MAX_GRID_BITS) for b in finer))

    fit = bisect_right(config.whole_bits, most_bytes, key=lambda more: made(more).size)
    return made(config.whole_bits[fit - 1]) if fit else None


def _most_faces(simplifier: Simplifier, most_bytes: float, config: FormConfig) -> Candidate:
    """As many faces as so many bytes allow, about; the fewest where they do not allow these."""
    least, everything = simplifier.config.fewest, len(simplifier.source.triangles)
    few, many = float(min(least, everything)), float(everything)
    aim, faces = config.size_aim * most_bytes, most_bytes / config.bytes_per_face
    best: Candidate | None = None
    for _ in range(config.size_trials):
        if not few <= faces <= many:
            faces = math.sqrt(few * many)
        found = simplifier.balanced(round(faces))
        if found.size > most_bytes:
            many = faces
        else:
            few = faces
            best = min(best or found, found, key=lambda each: each.errors.distance)
            if found.size >= (2 * config.size_aim - 1) * most_bytes:
                break
        faces *= aim / found.size
    return best or fewest(simplifier)


def _coarser(
    simplifier: Simplifier, found: Candidate, most_bytes: float, config: FormConfig
) -> Candidate:
    """About the same faces on coarser grids, until they take at most so many bytes.

    Bodies that are kept whole leave no fewer faces, but bits.
    """
    least, faces = config.least_bits, min(simplifier.config.fewest, found.faces)
    while found.size > most_bytes and max(found.bits, found.uv_bits) > least:
        bits, uv_bits = (max(each - 1, least) for each in (found.bits, found.uv_bits))
        found = simplifier.candidate(faces, bits, uv_bits)
    return found
