"""Parsing takes twice the file and a constant at most, whatever the file claims."""

from __future__ import annotations

import tracemalloc
from functools import cache

import msgpack
import numpy as np
import pytest

from nispcodec.core.errors import FormatError
from nispcodec.format import unpack
from nispcodec.format.codings import entropy
from nispcodec.format.constants import MAX_MEMORY
from tests.conformance.builder import Row, change, container
from tests.conformance.malformed import all_malformed, meta, nets, rows, squeezed

LARGE = meta({2: {1: {1: [512, 960, 512]}}})


def packed(code: bytes, data: bytes) -> Row:
    """A zstd section."""
    return Row(code, squeezed(data), flags=3, decoded=len(data))


@cache
def bombs() -> dict[str, bytes]:
    """Small files that unfold as far as the caps let them."""
    sizes = [(512, 3), (1, 512), (960, 512), (1, 960), (512, 960), (1, 512), (1, 512), (1, 1)]
    coo = b"\x02\0\x02" * 8
    dia = b"".join(_full_diagonals(*size) for size in sizes)
    few = np.zeros(512 * (3 + 1 + 512 + 1), np.int32)
    few[0] = 1
    zeros = entropy.SymbolRun(few)
    endless = b"\xde\0\0\0\x3f" + zeros.header() + b"\x26\0" * 2 + entropy.encode([zeros])
    texture = meta({8: [{1: "a"}]})
    crowd = bytes(msgpack.packb({1: [[b""] * 4000 for _ in range(4)]}))
    nested = b"\x81\x01" + b"\xdc\x10\x00" * 500
    return {
        "empty matrices": container(rows(LARGE, coo)),
        "full diagonals": container([rows(LARGE)[0], packed(b"NETS", dia)]),
        "endless tokens": container(rows(meta({2: {1: {1: [512, 512]}}}), endless)),
        "large texture": container([*rows(texture), packed(b"TXTR", bytes(2**25 - 2**20))]),
        "metadata crowd": container([packed(b"META", crowd), rows()[1]]),
        "metadata lists": container(
            [packed(b"META", b"\xdc\x00\x3c" + (b"\xdc\x10\x00" + b"\x90" * 4096) * 60), rows()[1]]
        ),
        "nested arrays": container(rows(nested)),
        "many charts": container(rows(meta({3: 65535, 5: bytes(8192)}))),
    }


def _full_diagonals(height: int, width: int) -> bytes:
    """Every diagonal of a matrix of float16 zeros, indices sized to the matrix."""
    count = height + width - 1
    wide = 1 if count - 1 < 256 else 2
    length = bytes([count]) if count < 128 else bytes([count & 127 | 128, count >> 7])
    return b"\x05" + length + bytes(wide * count) + b"\x02" + bytes(2 * height * width)


def peak(data: bytes) -> int:
    """Bytes allocated at most while parsing."""
    tracemalloc.start()
    try:
        unpack(data)
    except FormatError:
        pass
    finally:
        _, most = tracemalloc.get_traced_memory()
        tracemalloc.stop()
    return most


@pytest.mark.parametrize("name", bombs())
def test_bombs(name: str) -> None:
    data = bombs()[name]
    assert peak(data) <= 2 * len(data) + MAX_MEMORY


@pytest.mark.slow
def test_malformed_files_take_no_more() -> None:
    for case in all_malformed():
        assert peak(case.data) <= 2 * len(case.data) + MAX_MEMORY, case.name


def test_large_images_are_copied_once() -> None:
    size = 10 * 2**20
    texture = meta({8: [{1: "a"}]})
    data = container([*rows(texture), Row(b"TXTR", bytes(size))])
    assert peak(data) <= size + 2**20


def test_bombs_unfold() -> None:
    """They are what they claim to be: valid files, not early errors."""
    for name in ("empty matrices", "full diagonals", "endless tokens", "large texture"):
        assert unpack(bombs()[name]).networks["sdf"].spec.weight_count > 0
    assert (
        unpack(container(change(rows(), b"NETS", payload=nets()))).networks["sdf"].spec.weight_count
        == 11
    )
