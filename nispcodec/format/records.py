"""The records of NETS: a tensor in a coding of its own, or a run of them in the stream."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nispcodec.draw import BITS, Integers, draws, told
from nispcodec.errors import FormatError
from nispcodec.format import steps
from nispcodec.format.codings import coo, csc, csr, dense, dia, entropy
from nispcodec.format.codings.reader import Reader, varint
from nispcodec.format.constants import (
    CODINGS,
    MAX_JOINED,
    MAX_SYMBOL,
    MAX_UNPACKED,
    NETS,
    STEPS,
)
from nispcodec.format.container import pack_content
from nispcodec.network import Network, NetworkSpec, Weights

_OWN = {"dense": dense, "coo": coo, "csc": csc, "csr": csr, "dia": dia}
STREAMED = ("entropy", "drawn")


@dataclass(frozen=True)
class Tensor:
    """A tensor to write: its step, if it is quantised, and its weights or symbols in 2-D.

    `drawn` are the draws that it began from.
    """

    path: str
    step: float | None
    matrix: NDArray[Any]
    drawn: Integers

    @cached_property
    def reach(self) -> int:
        """That with which draws tell most of the symbols; 0 where they tell nothing."""
        if self.step is None:
            return 0
        symbols, shares = self.matrix.ravel(), self.drawn / (1 << BITS)
        fitted = float(symbols @ shares) / float(shares @ shares)
        reach = min(max(round(fitted), 0), MAX_SYMBOL)
        return reach if np.abs(symbols - told(self.drawn, reach)).max() <= MAX_SYMBOL else 0

    @property
    def moves(self) -> Integers:
        """How far the symbols are from what draws tell of them."""
        return self.matrix.ravel() - told(self.drawn, self.reach)


@dataclass(frozen=True)
class Record:
    """Tensors to write together; `before` is the step of the tensor before them."""

    coding: str
    tensors: list[Tensor]
    before: float | None

    @cached_property
    def run(self) -> entropy.Run | None:
        """What goes to the stream, if anything does."""
        if self.coding == "drawn":
            return entropy.Run(np.concatenate([tensor.moves for tensor in self.tensors]))
        if self.coding == "entropy":
            return entropy.Run(np.concatenate([tensor.matrix.ravel() for tensor in self.tensors]))
        return None

    def encode(self) -> bytes:
        """Tag, step, and the payload, or the reaches and the run's head."""
        first, form, step = self.tensors[0], 0, b""
        if first.step is not None:
            name, step = steps.encode(first.path, first.step, self.before)
            form = 1 + STEPS.index(name)
        tag = 1 + CODINGS.index(self.coding) | form << 3 | len(self.tensors) - 1 << 6
        if not self.run:
            return bytes([tag]) + step + _OWN[self.coding].encode(first.matrix)
        drawn = self.tensors if self.coding == "drawn" else []
        reaches = b"".join(varint(tensor.reach) for tensor in drawn)
        return bytes([tag]) + step + reaches + self.run.head()

    @cached_property
    def size(self) -> float:
        """Bytes in the file, about: the section is packed as a whole."""
        encoded = self.encode()
        if self.run:
            return len(encoded) + self.run.streamed()
        return len(pack_content(encoded, MAX_UNPACKED)[1])


@dataclass(frozen=True)
class Part:
    """A record that was read: the tensors it is of, their step, their values or the run's head.

    Symbols in the coding drawn lie `expected` further than the run has them.
    """

    names: list[str]
    step: float | None
    values: NDArray[Any] | None
    head: entropy.Head | None
    expected: Integers | None = None


Candidate = tuple[int, int, Record]
"""A record of the tensors from one number to below another."""


def candidates(name: str, network: Network) -> list[Candidate]:
    """Every record that tensors of a network can make.

    Raises `FormatError` for weights that are not multiples of their step.
    """
    tensors = _prepare(name, network)
    found = []
    for start, tensor in enumerate(tensors):
        before = tensors[start - 1].step if start else None
        found += [(start, start + 1, Record(coding, [tensor], before)) for coding in _OWN]
        for end in range(start + 1, min(start + 1 + MAX_JOINED, len(tensors)) + 1):
            run = tensors[start:end]
            if run[-1].step != tensor.step:
                break
            found.append((start, end, Record("entropy", run, before)))
            if any(each.reach for each in run):
                found.append((start, end, Record("drawn", run, before)))
    return found


def cheapest(candidates: list[Candidate], codings: tuple[str, ...]) -> list[Record]:
    """The records that cover all tensors, in some of the codings, in the fewest bytes."""
    plans: dict[int, tuple[float, list[Record]]] = {0: (0.0, [])}
    for start, end, record in candidates:
        if record.coding in codings:
            size = plans[start][0] + record.size
            if end not in plans or size < plans[end][0]:
                plans[end] = size, [*plans[start][1], record]
    return plans[max(plans)][1]


def _prepare(name: str, network: Network) -> list[Tensor]:
    tensors, drawn = [], _drawn(network.spec, network.tensors)
    for key, tensor in network.tensors.items():
        path, step = f"{name}.{key}", network.steps.get(key)
        # Adding 0 makes -0 a 0.
        values = tensor + np.float32(0) if step is None else _symbols(path, tensor, step)
        tensors.append(Tensor(path, step, values.reshape(_matrix_shape(tensor.shape)), drawn[key]))
    return tensors


def _drawn(spec: NetworkSpec, names: Iterable[str]) -> dict[str, Integers]:
    """Of each of these tensors the draws that it began from."""
    counts = {name: int(np.prod(shape)) for name, shape in spec.shapes.items()}
    places = dict(zip(counts, accumulate(counts.values(), initial=0), strict=False))
    return {name: draws(spec.draw, places[name], counts[name]) for name in names}


def read(reader: Reader, path: str, spec: NetworkSpec) -> list[Part]:
    """The records of the network at `path`."""
    parts: list[Part] = []
    names = list(spec.shapes)
    while names:
        reader.path = f"{path}.{names[0]}."
        parts.append(_read(reader, names, spec, parts[-1].step if parts else None))
        del names[: len(parts[-1].names)]
    reader.path = ""
    return parts


def _read(reader: Reader, left: list[str], spec: NetworkSpec, before: float | None) -> Part:
    tag = reader.take(1, "coding")[0]
    number, form, joined = tag & 7, tag >> 3 & 7, tag >> 6
    if not 1 <= number <= len(CODINGS):
        raise reader.error("coding", f"1 to {len(CODINGS)}", number)
    coding = CODINGS[number - 1]
    if form > len(STEPS):
        raise reader.error("step", f"0 to {len(STEPS)}", form)
    if coding == "drawn" and not form:
        raise reader.error("step", f"1 to {len(STEPS)} with drawn", form)
    most = len(left) - 1 if coding in STREAMED else 0
    if joined > most:
        raise reader.error("joined", f"at most {most} more tensors", joined)
    step = steps.decode(reader, STEPS[form - 1], before) if form else None
    names = left[: 1 + joined]
    if coding in STREAMED:
        expected = _expected(reader, names, spec) if coding == "drawn" else None
        count = sum(int(np.prod(spec.shapes[name])) for name in names)
        head = entropy.read_head(reader, count, step is not None)
        return Part(names, step, None, head, expected)
    coder, shape = _OWN[coding], _matrix_shape(spec.shapes[names[0]])
    return Part(names, step, coder.decode(reader, shape, step is not None).ravel(), None)


def _expected(reader: Reader, names: list[str], spec: NetworkSpec) -> Integers:
    """What draws tell of the symbols of some consecutive tensors."""
    drawn = _drawn(spec, names)
    reaches = [reader.varint("reach", MAX_SYMBOL) for _ in names]
    parts = [told(drawn[name], reach) for name, reach in zip(names, reaches, strict=True)]
    return np.concatenate(parts)


def _matrix_shape(shape: tuple[int, ...]) -> tuple[int, int]:
    """A bias is one row."""
    return (1, shape[0]) if len(shape) == 1 else (shape[0], shape[1])


def _symbols(path: str, tensor: Weights, step: float) -> NDArray[np.int32]:
    single = np.float32(step)
    if not 0 < single < np.inf:
        raise FormatError(NETS, f"{path}.step", "a positive float32", step)
    symbols = np.rint(tensor.astype(np.float64) / np.float64(single))
    if np.abs(symbols).max() > MAX_SYMBOL or (symbols.astype(np.float32) * single != tensor).any():
        raise FormatError(NETS, path, f"multiples of the step {step}", "other weights")
    return symbols.astype(np.int32)
