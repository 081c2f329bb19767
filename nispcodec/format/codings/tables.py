"""Frequency tables of tokens: four bits a token on disk, integers that sum to `SCALE` in use."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nispcodec.format.codings import bits
from nispcodec.format.codings.rans import SCALE
from nispcodec.format.codings.reader import Reader
from nispcodec.format.constants import LEVELS, MAX_TOKENS

Counts = NDArray[np.int64]


def frequencies(levels: list[int]) -> list[int]:
    """Levels (indices into `LEVELS`, not all 0) -> integer frequencies that sum to `SCALE`.

    Level 0 is a token that does not occur and has frequency 0; every other has 1 or more. The
    first of the most frequent tokens takes what rounding leaves over.
    """
    weights = [LEVELS[level] for level in levels]
    free = SCALE - sum(weight > 0 for weight in weights)
    total = sum(weights)
    table = [(weight > 0) + weight * free // total for weight in weights]
    table[table.index(max(table))] += SCALE - sum(table)
    return table


def levels(counts: Counts) -> list[int]:
    """(MAX_TOKENS,) counts -> the nearest levels, up to the last token that occurs."""
    steps = np.array(LEVELS[1:])
    borders = np.sqrt(steps[1:] * steps[:-1])
    nearest = 1 + np.searchsorted(borders, counts / counts.max() * steps[-1])
    used = np.where(counts > 0, nearest, 0)
    return [int(level) for level in used[: np.flatnonzero(counts)[-1] + 1]]


def encode(table: list[int]) -> bytes:
    """Levels -> how many, then four bits each."""
    widths = np.full(len(table), 4, np.uint8)
    return bytes([len(table)]) + bits.encode(np.array(table, np.uint32), widths)


def decode(reader: Reader) -> list[int]:
    """The inverse of `encode`; the last level is never 0."""
    count = reader.take(1, "token count")[0]
    if not 1 <= count <= MAX_TOKENS:
        raise reader.error("token count", f"1 to {MAX_TOKENS}", count)
    table = bits.decode(reader, "levels", np.full(count, 4, np.uint8)).tolist()
    if table[-1] == 0:
        raise reader.error("levels", "a last level above 0", 0)
    return [int(level) for level in table]


def coded_bits(counts: Counts, table: list[int]) -> float:
    """Bits for coding tokens of these counts with a table that has them all."""
    used = np.flatnonzero(counts)
    share = np.array(frequencies(table))[used] / SCALE
    return float(-(counts[used] * np.log2(share)).sum())


def share(histograms: list[Counts]) -> list[list[int]]:
    """Which histograms go under one table: groups of their positions.

    The largest first, each joins the group that it makes least costlier, unless a table of its own
    costs less.
    """
    groups: list[list[int]] = []
    sums: list[Counts] = []
    for position in sorted(range(len(histograms)), key=lambda i: -int(histograms[i].sum())):
        counts = histograms[position]
        added = [_cost(total + counts) - _cost(total) for total in sums]
        best = int(np.argmin([*added, _cost(counts)]))
        if best == len(groups):
            groups.append([])
            sums.append(np.zeros_like(counts))
        groups[best].append(position)
        sums[best] = sums[best] + counts
    return groups


def _cost(counts: Counts) -> float:
    table = levels(counts)
    return coded_bits(counts, table) + 8 + 4 * len(table)
