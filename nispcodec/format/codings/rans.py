"""A range asymmetric numeral system (rANS, Duda 2013) for tokens of small alphabets.

Our own rather than the `constriction` library's: its Python models take floating-point
probabilities, whose rounding to integers a specification would have to repeat; here the tables are
integers, and the decoder is eight lines of integer arithmetic in any language.

The state lives in [2^16, 2^32). A decoder starts with two 16-bit words, high word first, and takes
another word whenever the state falls below 2^16; it ends at exactly 2^16. Long streams take turns
between many states, so that a decoder can work on them side by side.
"""

from __future__ import annotations

from bisect import bisect_right
from operator import length_hint

import numpy as np

from nispcodec.core.arrays import Int64Array, IntArray, Uint16Array
from nispcodec.format.codings.reader import Reader

Runs = list[tuple[int, Int64Array]]
"""How many tokens, and where each token's frequency starts: (alphabet + 1,) from 0 to `SCALE`."""
Decoded = tuple[Int64Array, IntArray, int]
"""Tokens, the last states, how many words it took."""

SCALE_BITS = 14
SCALE = 1 << SCALE_BITS
LOW = 1 << 16
LONG = 1 << 14
TURNS_BITS = 9


def lanes(count: int) -> int:
    """How many states take turns in a stream of `count` tokens."""
    return count >> TURNS_BITS if count >= LONG else 1


def encode(starts: list[int], frequencies: list[int]) -> bytes:
    """Start and frequency of every token -> 16-bit words, little-endian; none without tokens."""
    if not starts:
        return b""
    count = lanes(len(starts))
    states = [LOW] * count
    words: list[int] = []
    for place in range(len(starts) - 1, -1, -1):
        state, frequency = states[place % count], frequencies[place]
        if state >= frequency << (32 - SCALE_BITS):
            words.append(state & 0xFFFF)
            state >>= 16
        state = (state // frequency << SCALE_BITS) + state % frequency + starts[place]
        states[place % count] = state
    for state in reversed(states):
        words += [state & 0xFFFF, state >> 16]
    return np.array(words[::-1], "<u2").tobytes()


def decode(reader: Reader, runs: Runs) -> Int64Array:
    """The inverse of `encode`: the tokens (n,) int64 of all runs, each with a table of its own.

    Raises FormatError for too few words, for a first state that no encoder ends with, and for
    another last state than the first of `encode`.
    """
    count = sum(length for length, _ in runs)
    if not count:
        return np.empty(0, np.int64)
    rest = reader.rest()
    words = np.frombuffer(rest[: len(rest) & ~1], "<u2")
    decoder = _one_by_one if lanes(count) == 1 else _side_by_side
    try:
        tokens, states, used = decoder(words, runs, lanes(count))
    except (StopIteration, IndexError):
        raise reader.error("words", "as many as the tokens need", len(words)) from None
    except ValueError as why:
        raise reader.error("first_state", f"at least {LOW}", why) from None
    reader.take(2 * used, "words")
    if (states != LOW).any():
        raise reader.error("final_state", LOW, int(states[states != LOW][0]))
    return tokens


def _first(least: int) -> int:
    """The state, or least state, that a stream begins with. Raises ValueError below `LOW`."""
    if least < LOW:
        raise ValueError(least)
    return least


def _one_by_one(words: Uint16Array, runs: Runs, _: int) -> Decoded:
    source = iter(words.tolist())
    following, mask, low = source.__next__, SCALE - 1, LOW
    tokens: list[int] = []
    append = tokens.append
    state = _first(following() << 16 | following())
    for count, table in runs:
        starts, frequencies = table[:-1].tolist(), np.diff(table).tolist()
        for _ in range(count):
            slot = state & mask
            token = bisect_right(starts, slot) - 1
            append(token)
            state = frequencies[token] * (state >> SCALE_BITS) + slot - starts[token]
            if state < low:
                state = state << 16 | following()
    return np.array(tokens), np.array([state]), len(words) - length_hint(source)


def _side_by_side(words: Uint16Array, runs: Runs, count: int) -> Decoded:
    """Here the tokens of all runs are numbered through, and so are their slots."""
    lengths = [length for length, _ in runs]
    firsts = np.cumsum([0] + [len(table) - 1 for _, table in runs])[:-1]
    starts = np.concatenate([table[:-1] for _, table in runs]).astype(np.uint32)
    frequencies = np.concatenate([np.diff(table) for _, table in runs]).astype(np.uint32)
    owners = np.repeat(np.arange(len(starts), dtype=np.uint32), frequencies)
    bases = np.repeat(np.arange(len(runs)) << SCALE_BITS, lengths)
    tokens = np.empty(len(bases), np.int64)
    used = 2 * count
    if used > len(words):
        raise IndexError
    states = words[0:used:2].astype(np.uint32) << 16 | words[1:used:2]
    _first(int(states.min()))
    for begin in range(0, len(bases), count):
        base = bases[begin : begin + count]
        state = states[: len(base)]
        slot = state & SCALE - 1
        token = owners.take(base + slot)
        tokens[begin : begin + count] = token
        state >>= SCALE_BITS
        state *= frequencies.take(token)
        state += slot - starts.take(token)
        low = (state < LOW).nonzero()[0]
        used += len(low)
        if used > len(words):
            raise IndexError
        state[low] = state.take(low) << 16 | words[used - len(low) : used]
    return tokens - np.repeat(firsts, lengths), states, used
