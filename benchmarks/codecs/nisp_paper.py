"""`.nisp` with the paper's networks, losses and optimiser."""

from __future__ import annotations

from benchmarks.codecs import Setting
from benchmarks.codecs.nisp import PAPER, decode, encode
from benchmarks.source import Source

__all__ = ["decode", "encode", "settings"]


def settings(source: Source, quick: bool) -> list[Setting]:
    """There is one."""
    return [{"preset": PAPER}]
