"""Our Zstandard decoder against the library that compresses."""

from __future__ import annotations

import random
from pathlib import Path

import zstandard

from tests.web.programs import HERE, run_node


def contents() -> dict[str, bytes]:
    """Data that make the library use every kind of block, literals and tables."""
    dice = random.Random(0)
    return {
        "text": (HERE.parent.parent / "format_spec.md").read_bytes(),
        "zeros": bytes(300_000),
        "four": bytes(dice.choice(b"abcd") for _ in range(70_000)),
        "bell": bytes(int(dice.gauss(128, 10)) & 255 for _ in range(3_000)),
        "skewed": bytes(int(dice.expovariate(0.2)) & 255 for _ in range(140_000)),
        "noise": dice.randbytes(200_000) + bytes(1_000),
        "short": b"hello hello hello hello hello",
    }


def test_it_decodes_what_the_library_compresses(tmp_path: Path) -> None:
    for name, data in contents().items():
        for level in (-5, 1, 3, 19):
            stem = f"{name}{level}"
            (tmp_path / stem).write_bytes(data)
            packed = zstandard.ZstdCompressor(level=level).compress(data)
            (tmp_path / f"{stem}.zst").write_bytes(packed)
    assert run_node(HERE / "unzstd.mjs", tmp_path) == ""
