"""The NETS section: the tensors of all networks, each in its own coding."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nispcodec.errors import FormatError
from nispcodec.format.codings import coo, csc, csr, dense, dia, entropy
from nispcodec.format.codings.reader import Reader
from nispcodec.format.constants import (
    CODINGS,
    MAX_SYMBOL,
    MAX_UNPACKED,
    MAX_WEIGHTS,
    NETS,
    QUANTISED,
    SHORT_STEP,
)
from nispcodec.format.container import pack_content
from nispcodec.network import Network, NetworkSpec, Weights

_OWN = {"dense": dense, "coo": coo, "csc": csc, "csr": csr, "dia": dia}


@dataclass(frozen=True)
class _Tensor:
    """A tensor to write: what its tag says besides the coding, its step, its values in 2-D."""

    mark: int
    step: bytes
    matrix: NDArray[Any]

    def record(self, coding: str, payload: bytes) -> bytes:
        return bytes([self.mark | 1 + CODINGS.index(coding)]) + self.step + payload


def encode(networks: dict[str, Network], coding: str | None) -> bytes:
    """All tensors in file order; `coding` None takes the fewest bytes."""
    if coding is not None and coding not in CODINGS:
        raise FormatError(NETS, "coding", f"one of {', '.join(CODINGS)}", coding)
    _check_count([network.spec for network in networks.values()])
    prepared = [_prepare_network(name, network) for name, network in networks.items()]
    if coding is not None:
        return _section(prepared, [[coding] * len(tensors) for tensors in prepared])
    # The section is packed as a whole, so that the best for each tensor may not be the best of all.
    choices = [*_choices(prepared), *([[name] * len(t) for t in prepared] for name in CODINGS)]
    return min((_section(prepared, choice) for choice in choices), key=_packed_length)


def decode(
    specs: dict[str, NetworkSpec], data: bytes | memoryview
) -> tuple[dict[str, Network], dict[str, int]]:
    """The networks of these specs, `MAX_WEIGHTS` weights at most, and the bytes of each."""
    _check_count(list(specs.values()))
    reader = Reader(NETS, data)
    networks, lengths = {}, {}
    for name, spec in specs.items():
        start = reader.position
        networks[name] = _decode_network(reader, name, spec)
        lengths[name] = reader.position - start
    reader.finish()
    return networks, lengths


def _check_count(specs: list[NetworkSpec]) -> None:
    total = sum(spec.weight_count for spec in specs)
    if total > MAX_WEIGHTS:
        raise FormatError(NETS, "weights", f"at most {MAX_WEIGHTS}", total)


def _choices(prepared: list[list[_Tensor]]) -> Iterator[list[list[str]]]:
    """The best coding for each tensor: without the coding entropy, then with it."""
    own = [[_best_own(tensor) for tensor in tensors] for tensors in prepared]
    yield [[coding for coding, _ in best] for best in own]
    pooled = [entropy.Pool([t.matrix.ravel() for t in tensors]).sizes() for tensors in prepared]
    yield [
        [
            coding if size <= pool_size else "entropy"
            for (coding, size), pool_size in zip(best, sizes, strict=True)
        ]
        for best, sizes in zip(own, pooled, strict=True)
    ]


def _section(prepared: list[list[_Tensor]], codings: list[list[str]]) -> bytes:
    return b"".join(map(_assemble, prepared, codings))


def _prepare_network(name: str, network: Network) -> list[_Tensor]:
    return [
        _prepare(f"{name}.{key}", tensor, network.steps.get(key))
        for key, tensor in network.tensors.items()
    ]


def _prepare(path: str, tensor: Weights, step: float | None) -> _Tensor:
    shape = _matrix_shape(tensor.shape)
    if step is None:
        return _Tensor(0, b"", (tensor + np.float32(0)).reshape(shape))  # adding 0 makes -0 a 0
    symbols = _symbols(path, tensor, step).reshape(shape)
    short = float(np.float16(step)) == float(np.float32(step))
    mark = QUANTISED | SHORT_STEP if short else QUANTISED
    return _Tensor(mark, struct.pack("<e" if short else "<f", step), symbols)


def _best_own(tensor: _Tensor) -> tuple[str, int]:
    """The coding of its own, without a pool, that takes the fewest bytes, and how many."""
    lengths = {name: _packed_length(coder.encode(tensor.matrix)) for name, coder in _OWN.items()}
    best = min(lengths, key=lambda name: lengths[name])
    return best, lengths[best]


def _packed_length(payload: bytes) -> int:
    """What the payload would take in the file."""
    return len(pack_content(payload, MAX_UNPACKED)[1])


def _assemble(tensors: list[_Tensor], codings: list[str]) -> bytes:
    chosen = [tensor for tensor, name in zip(tensors, codings, strict=True) if name == "entropy"]
    pool = entropy.Pool([tensor.matrix.ravel() for tensor in chosen]) if chosen else None
    heads = iter(pool.heads() if pool else [])
    records = [
        tensor.record(name, next(heads) if name == "entropy" else _OWN[name].encode(tensor.matrix))
        for tensor, name in zip(tensors, codings, strict=True)
    ]
    return b"".join(records) + (pool.encode() if pool else b"")


def _decode_network(reader: Reader, name: str, spec: NetworkSpec) -> Network:
    values: dict[str, NDArray[Any]] = {}
    heads: dict[str, entropy.Head] = {}
    steps: dict[str, float] = {}
    for key, shape in spec.shapes.items():
        reader.path = f"{name}.{key}."
        coding, step = _read_tag(reader)
        if step is not None:
            steps[key] = step
        if coding == "entropy":
            heads[key] = entropy.read_head(reader, int(np.prod(shape)), step is not None)
        else:
            values[key] = _OWN[coding].decode(reader, _matrix_shape(shape), step is not None)
    reader.path = f"{name}."
    if heads:
        values |= zip(heads, entropy.decode(reader, list(heads.values())), strict=True)
    tensors = {
        key: _scale(reader, key, values[key], steps.get(key)).reshape(shape)
        for key, shape in spec.shapes.items()
    }
    reader.path = ""
    return Network(spec, tensors, steps)


def _read_tag(reader: Reader) -> tuple[str, float | None]:
    """Coding and step of the next tensor."""
    tag = reader.take(1, "coding")[0]
    quantised, short = bool(tag & QUANTISED), bool(tag & SHORT_STEP)
    number = tag & ~(QUANTISED | SHORT_STEP)
    if not 1 <= number <= len(CODINGS):
        raise reader.error("coding", f"1 to {len(CODINGS)}", number)
    if short and not quantised:
        raise reader.error("coding", "no step width without a step", tag)
    if not quantised:
        return CODINGS[number - 1], None
    step = float(struct.unpack("<e" if short else "<f", reader.take(2 if short else 4, "step"))[0])
    if not 0 < step < np.inf:
        raise reader.error("step", "a positive number", step)
    return CODINGS[number - 1], step


def _scale(reader: Reader, key: str, values: NDArray[Any], step: float | None) -> Weights:
    scaled = values if step is None else _multiplied(reader, key, values, step)
    if not np.isfinite(scaled).all():
        raise reader.error(key, "finite weights", "NaN or infinity")
    return np.ascontiguousarray(scaled)


def _multiplied(reader: Reader, key: str, symbols: NDArray[Any], step: float) -> Weights:
    largest = max(int(symbols.max()), -int(symbols.min()))
    if largest > MAX_SYMBOL:
        raise reader.error(key, f"symbols up to {MAX_SYMBOL}", largest)
    with np.errstate(over="ignore"):
        return symbols.astype(np.float32) * np.float32(step)


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
