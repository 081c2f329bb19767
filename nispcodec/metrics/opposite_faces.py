"""Faces that lie back to back: the two sides of a leaf or a flag."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float64Array, Int64Array, IntArray, Uint64Array

# Odd, so that multiplying loses no bit.
FACTORS = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], np.uint64)
DOWN = np.uint64(32)


def opposite_faces(positions: Float64Array, faces: IntArray, normals: Float64Array) -> Int64Array:
    """(m,) int64: for each face another with the same corners that looks the other way, else -1.

    positions (n, 3), the corners (m, 3) and unit normals (m, 3) of faces; positions are compared by
    value.
    """
    # Corners in any order have the same sum.
    codes = _codes(positions)[faces].sum(axis=1)
    order = np.argsort(codes, kind="stable")
    same = codes[order[:-1]] == codes[order[1:]]
    first, second = order[:-1][same], order[1:][same]
    opposite = (normals[first] * normals[second]).sum(axis=1) < 0
    found = np.full(len(faces), -1, np.int64)
    found[first[opposite]], found[second[opposite]] = second[opposite], first[opposite]
    return found


def _codes(positions: Float64Array) -> Uint64Array:
    """(..., 3) -> (...): a number for each position, another one for any other but by accident."""
    # Adding zero makes -0 and 0 the same bits; a sign alone must not stay in the uppermost.
    bits = (positions + 0.0).view(np.uint64)
    mixed = (bits ^ bits >> DOWN) * FACTORS
    codes: Uint64Array = ((mixed ^ mixed >> DOWN) * FACTORS[::-1]).sum(axis=-1)
    return codes
