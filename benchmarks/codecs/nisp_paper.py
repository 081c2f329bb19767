"""`.nisp` with the paper's networks, losses and optimizer, whole and pruned."""

from __future__ import annotations

from typing import Any

from benchmarks.assets.source import Source
from benchmarks.codecs import Setting
from benchmarks.codecs.nisp import PAPER, decode, encoded

__all__ = ["decode", "encode", "settings"]

# What the paper prunes without loss, and how (section 4.3); its SDF stays whole.
STRATEGY = "smallest"
RATES = {"chart": 0.844, "uv": 0.644}


def settings(source: Source, quick: bool) -> list[Setting]:
    """Whole and pruned; the latter trains three times."""
    return [{"preset": PAPER}, {"preset": PAPER, "prune": STRATEGY}]


def encode(source: Source, setting: Setting) -> bytes:
    """As `.nisp`'s; what is pruned is pruned by `RATES`."""
    options: dict[str, Any] = {**setting}
    if "prune" in setting:
        options["prune_rate"] = RATES
    return encoded(source, options)
