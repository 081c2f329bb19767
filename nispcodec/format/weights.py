"""The NETS section: the records of all networks' tensors, then one rANS stream."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from nispcodec.core.arrays import AnyArray, Float32Array
from nispcodec.core.errors import FormatError
from nispcodec.core.network import Network, NetworkSpec
from nispcodec.format import records
from nispcodec.format.codings import entropy
from nispcodec.format.codings.reader import Reader
from nispcodec.format.codings.registry import BY_NAME, CODINGS, REGISTRY
from nispcodec.format.constants import MAX_SYMBOL, MAX_UNPACKED, MAX_WEIGHTS, NETS
from nispcodec.format.container import pack_content
from nispcodec.format.records import Part, Record


def encode(networks: dict[str, Network], coding: str | None) -> bytes:
    """The bytes of NETS: all tensors in file order; `coding` None takes the fewest bytes.

    Raises FormatError for an unknown coding, more than `MAX_WEIGHTS` weights, and weights that are
    not multiples of their step.
    """
    if coding is not None and coding not in BY_NAME:
        raise FormatError(NETS, "coding", f"one of {', '.join(CODINGS)}", coding)
    _check_count([network.spec for network in networks.values()])
    prepared = [records.candidates(name, network) for name, network in networks.items()]
    own = [each for each in REGISTRY if each.codec]
    streamed = [each for each in REGISTRY if not each.codec]
    # The section is packed as a whole, so that the best for each tensor may not be the best of all.
    choices = [*([each] for each in own), streamed, own, list(REGISTRY)]
    if coding:
        # Weights that are no symbols, or that nothing predicts, cannot be differences.
        wanted = BY_NAME[coding]
        choices = [streamed if wanted.predicts else [wanted]]
    sections = (
        _section([record for each in prepared for record in records.cheapest(each, choice)])
        for choice in choices
    )
    return min(sections, key=lambda section: len(pack_content(section, MAX_UNPACKED)[1]))


def decode(
    specs: dict[str, NetworkSpec], data: bytes | memoryview
) -> tuple[dict[str, Network], dict[str, int]]:
    """The networks of these specs, `MAX_WEIGHTS` weights at most, and the bytes of each.

    The stream is one for all networks: its bytes are split by the bits that each of them needs.
    Raises FormatError for malformed bytes.
    """
    _check_count(list(specs.values()))
    reader = Reader(NETS, data)
    read: dict[str, list[Part]] = {}
    ends = [0]
    for name, spec in specs.items():
        read[name] = records.read(reader, name, spec)
        ends.append(reader.position)
    headers = [part.header for parts in read.values() for part in parts if part.header]
    coded = iter(entropy.decode(reader, headers))
    reader.finish()
    networks, bits = {}, [0.0]
    for name, spec in specs.items():
        values = [_values(part, coded) for part in read[name]]
        bits.append(sum(cost for _, cost in values))
        flat = [each for each, _ in values]
        networks[name] = _network(reader, name, spec, read[name], flat)
    stream = (reader.position - ends[-1]) * np.cumsum(bits) / (sum(bits) or 1)
    lengths = np.diff(ends) + np.diff(np.rint(stream).astype(int))
    return networks, dict(zip(specs, map(int, lengths), strict=True))


def _values(part: Part, coded: Iterator[entropy.Coded]) -> entropy.Coded:
    """Weights or symbols of a record, and the bits that they take in the stream."""
    values, bits = next(coded) if part.values is None else (part.values, 0.0)
    return values if part.step is None else values + part.expected << part.row_shifts, bits


def _section(chosen: list[Record]) -> bytes:
    runs = [record.run for record in chosen if record.run]
    return b"".join(record.encode() for record in chosen) + entropy.encode(runs)


def _check_count(specs: list[NetworkSpec]) -> None:
    total = sum(spec.weight_count for spec in specs)
    if total > MAX_WEIGHTS:
        raise FormatError(NETS, "weights", f"at most {MAX_WEIGHTS}", total)


def _network(
    reader: Reader, name: str, spec: NetworkSpec, parts: list[Part], values: list[AnyArray]
) -> Network:
    tensors, steps, every = {}, {}, spec.shapes
    for part, flat in zip(parts, values, strict=True):
        shapes = [every[key] for key in part.names]
        ends = np.cumsum([int(np.prod(shape)) for shape in shapes])[:-1]
        for key, shape, each in zip(part.names, shapes, np.split(flat, ends), strict=True):
            tensors[key] = _scale(reader, f"{name}.{key}", each, part.step).reshape(shape)
            if part.step is not None:
                steps[key] = part.step
    return Network(spec, tensors, steps)


def _scale(reader: Reader, path: str, values: AnyArray, step: float | None) -> Float32Array:
    scaled = values if step is None else _multiplied(reader, path, values, step)
    if not np.isfinite(scaled).all():
        raise reader.error(path, "finite weights", "NaN or infinity")
    return np.ascontiguousarray(scaled)


def _multiplied(reader: Reader, path: str, symbols: AnyArray, step: float) -> Float32Array:
    largest = max(int(symbols.max()), -int(symbols.min()))
    if largest > MAX_SYMBOL:
        raise reader.error(path, f"symbols up to {MAX_SYMBOL}", largest)
    with np.errstate(over="ignore"):
        return symbols.astype(np.float32) * np.float32(step)
