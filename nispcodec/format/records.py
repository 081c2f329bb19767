"""The records of NETS: a tensor in a coding of its own, or a run of them in the stream."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from nispcodec.core.arrays import AnyArray, Float32Array, Int32Array, Int64Array
from nispcodec.core.errors import FormatError
from nispcodec.core.initial_weights import predicted
from nispcodec.core.network import Network, NetworkSpec
from nispcodec.format import steps, tag
from nispcodec.format.codings import entropy
from nispcodec.format.codings.reader import Reader, varint
from nispcodec.format.codings.registry import BY_NUMBER, REGISTRY, Coding
from nispcodec.format.constants import MAX_SYMBOL, MAX_UNPACKED, NETS, STEPS
from nispcodec.format.container import pack_content
from nispcodec.format.tag import MOST_TOGETHER, Tag
from nispcodec.format.tensor import Tensor

_NONE = [np.zeros(1, np.int64)]


@dataclass(frozen=True)
class Record:
    """Tensors to write together, all of one step.

    before   the step of the tensor before them, None if it has none
    width    bits of the row shifts; 0 where rows have none
    """

    coding: Coding
    tensors: list[Tensor]
    before: float | None
    width: int

    @cached_property
    def run(self) -> entropy.SymbolRun | None:
        """The values that go to the stream; None for a coding that has its own payload."""
        if self.coding.codec:
            return None
        return entropy.SymbolRun(np.concatenate([each.ravel() for each in self._values]))

    def encode(self) -> bytes:
        """The bytes: tag, step, row shifts, then the payload, or initial scales and run header.

        Raises FormatError for a step that is no positive float32.
        """
        first, form, step = self.tensors[0], 0, b""
        if first.step is not None:
            row_shifts = np.concatenate(self._row_shifts)
            name, step = steps.encode(first.path, first.step, self.before, row_shifts, self.width)
            form = 1 + STEPS.index(name)
        start = Tag(self.coding.number, form, len(self.tensors) - 1).encode() + step
        if self.coding.codec:
            return start + self.coding.codec.encode(self._values[0])
        assert self.run is not None
        scaled = self.tensors if self.coding.predicts else []
        scales = b"".join(varint(tensor.init_scale) for tensor in scaled)
        return start + scales + self.run.header()

    @property
    def _row_shifts(self) -> list[Int64Array]:
        return [np.minimum(tensor.row_shifts, (1 << self.width) - 1) for tensor in self.tensors]

    @property
    def _values(self) -> list[AnyArray]:
        pairs, delta = zip(self.tensors, self._row_shifts, strict=True), self.coding.predicts
        return [tensor.values(row_shifts, delta) for tensor, row_shifts in pairs]

    @cached_property
    def size(self) -> float:
        """Bytes in the file, about: the section is packed as a whole."""
        encoded = self.encode()
        if self.run:
            return len(encoded) + self.run.streamed()
        return len(pack_content(encoded, MAX_UNPACKED)[1])


@dataclass(frozen=True)
class Part:
    """A record that was read: names and step of its tensors, and their values or the run's header.

    Symbols are the values read, plus `expected`, times two to the power of `row_shifts`. Both are
    (n,) for the n weights, or (1,) for all of them.
    """

    names: list[str]
    step: float | None
    values: AnyArray | None
    header: entropy.RunHeader | None
    row_shifts: Int64Array
    expected: Int64Array


Candidate = tuple[int, int, Record]
"""The first tensor of a record, the one after its last, and the record."""


def candidates(name: str, network: Network) -> list[Candidate]:
    """Every record that tensors of a network, `name` in errors, can make.

    Raises FormatError as `tensors` does.
    """
    every = tensors(name, network)
    found = []
    for start in range(len(every)):
        before = every[start - 1].step if start else None
        for end in range(start + 1, min(start + MOST_TOGETHER, len(every)) + 1):
            run = every[start:end]
            if run[-1].step != run[0].step:
                break
            found += [(start, end, record) for record in _records(run, before)]
    return found


def _records(run: list[Tensor], before: float | None) -> Iterator[Record]:
    """Every record of these tensors."""
    predictable = any(tensor.init_scale for tensor in run)
    codings = [
        coding
        for coding in REGISTRY
        if (len(run) == 1 if coding.codec else predictable or not coding.predicts)
    ]
    widest = max(int(tensor.row_shifts.max()) for tensor in run).bit_length()
    rows = run[0].step is not None and steps.has_row_shifts(run[0].step)
    for width in {0, widest if rows else 0}:
        yield from (Record(coding, run, before, width) for coding in codings)


def cheapest(candidates: list[Candidate], codings: Sequence[Coding]) -> list[Record]:
    """The records that cover all tensors in the fewest bytes, of candidates in the `codings`.

    Shortest path over the tensors, in file order.
    """
    plans: dict[int, tuple[float, list[Record]]] = {0: (0.0, [])}
    for start, end, record in candidates:
        if record.coding in codings:
            size = plans[start][0] + record.size
            if end not in plans or size < plans[end][0]:
                plans[end] = size, [*plans[start][1], record]
    return plans[max(plans)][1]


def tensors(name: str, network: Network) -> list[Tensor]:
    """The tensors of a network, `name` in errors, as they are written.

    Raises FormatError for weights that are not multiples of their step.
    """
    found, initial = [], network.spec.initial_integers(network.tensors)
    for key, tensor in network.tensors.items():
        path, step = f"{name}.{key}", network.steps.get(key)
        # Adding 0 makes -0 a 0.
        values = tensor + np.float32(0) if step is None else _symbols(path, tensor, step)
        shape = _matrix_shape(tensor.shape)
        found.append(Tensor(path, step, values.reshape(shape), initial[key].reshape(shape)))
    return found


def read(reader: Reader, path: str, spec: NetworkSpec) -> list[Part]:
    """The records of a network, `path` in errors. Raises FormatError at the reader's place."""
    parts: list[Part] = []
    names = list(spec.shapes)
    while names:
        reader.path = f"{path}.{names[0]}."
        parts.append(_read(reader, names, spec, parts[-1].step if parts else None))
        del names[: len(parts[-1].names)]
    reader.path = ""
    return parts


def _read(reader: Reader, left: list[str], spec: NetworkSpec, before: float | None) -> Part:
    start = tag.decode(reader)
    coding, form = BY_NUMBER[start.coding], start.form
    if coding.predicts and not form:
        raise reader.error("step", f"1 to {len(STEPS)} with {coding.name}", form)
    most = 0 if coding.codec else len(left) - 1
    if start.joined > most:
        raise reader.error("joined", f"at most {most} more tensors", start.joined)
    step = steps.decode(reader, STEPS[form - 1], before) if form else None
    names = left[: 1 + start.joined]
    shapes = [_matrix_shape(spec.shapes[name]) for name in names]
    every = _row_shifts(reader, STEPS[form - 1], shapes) if form else _NONE
    row_shifts = np.concatenate([each.ravel() for each in every])
    if coding.codec:
        values = coding.codec.decode(reader, shapes[0], step is not None).ravel()
        return Part(names, step, values, None, row_shifts, _NONE[0])
    expected = _NONE[0]
    if coding.predicts:
        expected = _expected(reader, spec.initial_integers(names), every)
    count = sum(math.prod(shape) for shape in shapes)
    header = entropy.read_header(reader, count, step is not None)
    return Part(names, step, None, header, row_shifts, expected)


def _row_shifts(reader: Reader, form: str, shapes: list[tuple[int, int]]) -> list[Int64Array]:
    """(rows, columns) those of every weight of some tensors."""
    rows = [shape[0] for shape in shapes]
    found = np.split(steps.decode_row_shifts(reader, form, sum(rows)), np.cumsum(rows)[:-1])
    pairs = zip(found, shapes, strict=True)
    return [np.broadcast_to(row_shifts[:, None], shape) for row_shifts, shape in pairs]


def _expected(
    reader: Reader, initial: dict[str, Int64Array], row_shifts: list[Int64Array]
) -> Int64Array:
    """The symbols of some tensors as their initial weights predict them."""
    scales = [reader.varint("init_scale", MAX_SYMBOL) for _ in initial]
    every = zip(initial.values(), scales, row_shifts, strict=True)
    parts = [predicted(each.reshape(by.shape), scale, by) for each, scale, by in every]
    return np.concatenate([part.ravel() for part in parts])


def _matrix_shape(shape: tuple[int, ...]) -> tuple[int, int]:
    """A bias is one row."""
    return (1, shape[0]) if len(shape) == 1 else (shape[0], shape[1])


def _symbols(path: str, tensor: Float32Array, step: float) -> Int32Array:
    single = np.float32(step)
    if not 0 < single < np.inf:
        raise FormatError(NETS, f"{path}.step", "a positive float32", step)
    symbols = np.rint(tensor.astype(np.float64) / np.float64(single))
    if np.abs(symbols).max() > MAX_SYMBOL or (symbols.astype(np.float32) * single != tensor).any():
        raise FormatError(NETS, path, f"multiples of the step {step}", "other weights")
    return symbols.astype(np.int32)
