"""Every weight coding: its number and name on disk, and its codec. A new one is a line here.

A codec of its own is a module with

    encode(values) -> bytes                        values (rows, columns) float32 or int32 symbols
    decode(reader, shape, symbols) -> values       raises FormatError at the reader's place

Codings without one put their values into the stream that all tensors share (`entropy`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from nispcodec.core.arrays import AnyArray
from nispcodec.format.codings import coo, csc, csr, dense, dia
from nispcodec.format.codings.reader import Reader


class Codec(Protocol):
    """The functions of a module that codes one tensor."""

    def encode(self, values: AnyArray) -> bytes:
        """(rows, columns) float32 weights or int32 symbols -> payload."""

    def decode(self, reader: Reader, shape: tuple[int, int], symbols: bool) -> AnyArray:
        """Payload -> (rows, columns) float32, or int32 where `symbols`.

        Raises FormatError at the reader's place.
        """


@dataclass(frozen=True)
class Coding:
    """One coding.

    number   in a record's tag
    codec    None: values go to the stream
    predicts values are stored less what the initial weights predict
    """

    number: int
    name: str
    codec: Codec | None = None
    predicts: bool = False


REGISTRY = (
    Coding(1, "dense", dense),
    Coding(2, "coo", coo),
    Coding(3, "csc", csc),
    Coding(4, "csr", csr),
    Coding(5, "dia", dia),
    Coding(6, "entropy"),
    Coding(7, "delta_init", predicts=True),
)
CODINGS = tuple(coding.name for coding in REGISTRY)
BY_NUMBER = {coding.number: coding for coding in REGISTRY}
BY_NAME = {coding.name: coding for coding in REGISTRY}
"""Names in the order of their numbers, and the codings by either."""
