"""Triangles of at most so many bytes: the nearest that are found in a few trials."""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import replace

import numpy as np

from nispcodec.core.mesh_part import MAX_GRID_BITS
from nispcodec.encode.config import FormConfig
from nispcodec.simplify.ladder import Candidate, Simplifier

TINY = float(np.finfo(np.float64).tiny)


def nearest_of_size(simplifier: Simplifier, most_bytes: float, config: FormConfig) -> Candidate:
    """The nearest candidate found of at most so many bytes; the smallest where none is.

    All faces where the finest grids have room; else the better of all of them on grids as fine as
    there is room for, and of as many faces as there is room for.
    """
    grids, all_faces = config.whole_bits, len(simplifier.source.triangles)
    fit = 0
    if all_faces * config.least_bytes_per_face <= most_bytes:
        fit = bisect_right(
            range(len(grids)), most_bytes, key=lambda grid: _whole(simplifier, grid, config).size
        )
    if fit == len(grids):
        return _whole(simplifier, fit - 1, config)
    fewer = _most_faces(simplifier, most_bytes, config)
    found = [_coarser(simplifier, fewer, most_bytes, config)]
    if fit:
        found.append(_whole(simplifier, fit - 1, config))
    # Here no error is too small to count.
    exact = replace(config, negligible=TINY, negligible_uv=TINY)
    return min(found, key=lambda each: exact.error_cost(each.errors))


def fewest(simplifier: Simplifier) -> Candidate:
    """The candidate of the fewest faces that are made."""
    return simplifier.balanced(min(simplifier.config.fewest, len(simplifier.source.triangles)))


def _whole(simplifier: Simplifier, grid: int, config: FormConfig) -> Candidate:
    """Every face on grids of `config.whole_bits`, by their number."""
    more, more_uv = config.whole_bits[grid]
    bits = simplifier.bits_for(config.negligible, whole=True) + more
    uv_bits = simplifier.uv_bits_for(config.negligible_uv) + more_uv
    within = (min(max(1, each), MAX_GRID_BITS) for each in (bits, uv_bits))
    return simplifier.candidate(len(simplifier.source.triangles), *within)


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
