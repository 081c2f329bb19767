"""A range asymmetric numeral system (rANS, Duda 2013) for tokens of a small alphabet.

Our own rather than the `constriction` library's: its Python models take floating-point
probabilities, whose rounding to integers a specification would have to repeat; here the tables are
integers in the file, and the decoder is eight lines of integer arithmetic in any language.

The state lives in [2^16, 2^32). A decoder starts with two 16-bit words, high word first, and takes
another word whenever the state falls below 2^16; it ends at exactly 2^16, all words read.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable

from nispcodec.format.codings.reader import Reader, varint

SCALE_BITS = 12
SCALE = 1 << SCALE_BITS
LOW = 1 << 16


def encode(runs: Iterable[tuple[bytes, list[int]]]) -> bytes:
    """Runs of (tokens, frequencies) -> how many words, then the words, little-endian."""
    state = LOW
    words: list[int] = []
    for tokens, table in reversed(list(runs)):
        starts = _starts(table)
        for token in reversed(tokens):
            frequency = table[token]
            if state >= frequency << (32 - SCALE_BITS):
                words.append(state & 0xFFFF)
                state >>= 16
            state = (state // frequency << SCALE_BITS) + state % frequency + starts[token]
    words += [state & 0xFFFF, state >> 16]
    words.reverse()
    return varint(len(words)) + struct.pack(f"<{len(words)}H", *words)


def decode(reader: Reader, runs: list[tuple[int, list[int]]]) -> bytes:
    """The inverse of `encode`, from runs of (count, frequencies): all tokens in one string."""
    most = 2 + sum(count for count, _ in runs)
    length = reader.varint("word count", most)
    words = iter(struct.unpack(f"<{length}H", reader.take(2 * length, "words")))
    try:
        state = next(words) << 16 | next(words)
        tokens = bytearray()
        for count, table in runs:
            state = _decode_run(words, state, count, table, tokens)
    except StopIteration:
        raise reader.error("words", "as many as the tokens need", length) from None
    left = len(list(words))
    if state != LOW or left:
        raise reader.error("final state", f"{LOW}, no words left", f"{state}, {left} words left")
    return bytes(tokens)


def _decode_run(
    words: Iterable[int], state: int, count: int, table: list[int], tokens: bytearray
) -> int:
    starts = _starts(table)
    owners = b"".join(bytes([token]) * frequency for token, frequency in enumerate(table))
    following = iter(words).__next__
    for _ in range(count):
        slot = state & SCALE - 1
        token = owners[slot]
        tokens.append(token)
        state = table[token] * (state >> SCALE_BITS) + slot - starts[token]
        if state < LOW:
            state = state << 16 | following()
    return state


def _starts(table: list[int]) -> list[int]:
    return [sum(table[:token]) for token in range(len(table))]
