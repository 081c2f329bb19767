"""A record's tag: its coding, the form of its step, how many more tensors it holds.

One byte for all that this version's writer needs. A wide tag, which begins with a byte of 0, has a
byte for each of the three: so the enumerations can grow, and no file of today does.
"""

from __future__ import annotations

from dataclasses import dataclass

from nispcodec.core.errors import FormatError
from nispcodec.format.codings.reader import Reader
from nispcodec.format.codings.registry import BY_NUMBER, REGISTRY
from nispcodec.format.constants import STEPS

MOST_TOGETHER = 4
"""Tensors that one record can hold with a short tag."""
_WIDE = b"\0"


@dataclass(frozen=True)
class Tag:
    """The begin of a record: coding, step, tensors.

    coding   number of the coding
    form     0 without step, else the number of its form, of `STEPS`
    joined   tensors in the record besides its first
    """

    coding: int
    form: int
    joined: int

    @property
    def is_short(self) -> bool:
        """Whether a single byte holds it."""
        return self.coding <= 7 and self.form <= 7 and self.joined < MOST_TOGETHER

    def encode(self) -> bytes:
        """One byte, or four where one is not enough."""
        if self.is_short:
            return bytes([self.coding | self.form << 3 | self.joined << 6])
        return _WIDE + bytes([self.coding, self.form, self.joined])


def decode(reader: Reader) -> Tag:
    """The inverse of `Tag.encode`.

    Raises FormatError at the reader's place for an unknown coding or form, and for a wide tag where
    a short one holds the same.
    """
    first = reader.take(1, "coding")[0]
    if first:
        return _known(reader, Tag(first & 7, first >> 3 & 7, first >> 6))
    tag = _known(reader, Tag(*reader.take(3, "coding")))
    if tag.is_short:
        raise reader.error("coding", "a tag of one byte, being short enough", "a wide tag")
    return tag


def _known(reader: Reader, tag: Tag) -> Tag:
    if tag.coding not in BY_NUMBER:
        raise _unknown(reader, "coding", len(REGISTRY), tag.coding)
    if tag.form > len(STEPS):
        raise _unknown(reader, "step", len(STEPS), tag.form)
    return tag


def _unknown(reader: Reader, name: str, known: int, found: int) -> FormatError:
    return reader.error(name, f"a number up to {known}, of this version", found)
