"""The NETS section: the tensors of all networks, each in its own coding."""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nispcodec.errors import FormatError
from nispcodec.format.codings import dense
from nispcodec.format.codings.reader import Reader
from nispcodec.format.constants import CODINGS, MAX_SYMBOL, MAX_WEIGHTS, NETS
from nispcodec.network import Network, NetworkSpec, Weights

_CODERS = {"dense": dense}
_QUANTISED = 0x80


def encode(networks: dict[str, Network], coding: str | None) -> bytes:
    """All tensors in file order; `coding` None takes the fewest bytes for each."""
    return b"".join(
        _encode_tensor(f"{name}.{key}", tensor, network.steps.get(key), coding)
        for name, network in networks.items()
        for key, tensor in network.tensors.items()
    )


def decode(specs: dict[str, NetworkSpec], data: bytes) -> dict[str, Network]:
    """The networks of these specs; allocates 8 bytes a weight at most, `MAX_WEIGHTS` in all."""
    total = sum(spec.weight_count for spec in specs.values())
    if total > MAX_WEIGHTS:
        raise FormatError(NETS, "weights", f"at most {MAX_WEIGHTS}", total)
    reader = Reader(NETS, data)
    networks = {name: _decode_network(reader, name, spec) for name, spec in specs.items()}
    reader.path = ""
    reader.finish()
    return networks


def _decode_network(reader: Reader, name: str, spec: NetworkSpec) -> Network:
    tensors: dict[str, Weights] = {}
    steps: dict[str, float] = {}
    for key, shape in spec.shapes.items():
        reader.path = f"{name}.{key}."
        tensors[key], step = _decode_tensor(reader, shape)
        if step is not None:
            steps[key] = step
    return Network(spec, tensors, steps)


def _encode_tensor(path: str, tensor: Weights, step: float | None, coding: str | None) -> bytes:
    matrix = _matrix(tensor.shape)
    values = tensor if step is None else _symbols(path, tensor, step)
    head = b"" if step is None else struct.pack("<f", step)
    mark = 0 if step is None else _QUANTISED
    candidates: list[bytes] = []
    for name in CODINGS if coding is None else (coding,):
        payload = _CODERS[name].encode(values.reshape(matrix)) if name in _CODERS else None
        if payload is not None:
            candidates.append(bytes([mark | 1 + CODINGS.index(name)]) + head + payload)
    return min(candidates, key=len)


def _decode_tensor(reader: Reader, shape: tuple[int, ...]) -> tuple[Weights, float | None]:
    tag = reader.take(1, "coding")[0]
    quantised, number = bool(tag & _QUANTISED), tag & ~_QUANTISED
    if not 1 <= number <= len(CODINGS):
        raise reader.error("coding", f"1 to {len(CODINGS)}", number)
    step = _read_step(reader) if quantised else None
    coder = _CODERS[CODINGS[number - 1]]
    values = coder.decode(reader, _matrix(shape), quantised).reshape(shape)
    if step is None:
        return values, None
    with np.errstate(over="ignore"):
        return values.astype(np.float32) * np.float32(step), step


def _matrix(shape: tuple[int, ...]) -> tuple[int, int]:
    """A bias is one row."""
    return (1, shape[0]) if len(shape) == 1 else (shape[0], shape[1])


def _read_step(reader: Reader) -> float:
    step = float(struct.unpack("<f", reader.take(4, "step"))[0])
    if not 0 < step < np.inf:
        raise reader.error("step", "a positive number", step)
    return step


def _symbols(path: str, tensor: Weights, step: float) -> NDArray[Any]:
    single = np.float32(step)
    if not 0 < single < np.inf:
        raise FormatError(NETS, f"{path}.step", "a positive float32", step)
    symbols = np.rint(tensor.astype(np.float64) / np.float64(single))
    exact = symbols.astype(np.float32) * single == tensor
    if np.abs(symbols).max(initial=0) >= MAX_SYMBOL or not exact.all():
        raise FormatError(NETS, path, f"multiples of the step {step}", "other weights")
    return symbols.astype(np.int32)


def sizes(specs: dict[str, NetworkSpec], data: bytes) -> dict[str, int]:
    """Bytes of each network in the decoded section."""
    reader = Reader(NETS, data)
    lengths = {}
    for name, spec in specs.items():
        start = reader.position
        _decode_network(reader, name, spec)
        lengths[name] = reader.position - start
    return lengths
