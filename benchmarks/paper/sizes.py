"""Weights of the published networks, unpruned and in every sparse coding (paper, table 2)."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from benchmarks.paper.row import Comparison
from benchmarks.studies.codings import COMPONENT, PAPER, PRUNED, UV, measured, pruned, stored
from nispcodec.core.network import NetworkSpec

TABLE = "Sizes (table 2)"
UNPRUNED = {"point2component": (COMPONENT, 174.4), "point2UV": (UV, 129.1)}
OURS_IS = "ours: bytes in a .nisp; published: .npz; weights are random, as theirs are not published"


def sizes() -> Iterator[Comparison]:
    """kB of both networks, float32 as published."""
    for name, (spec, published) in UNPRUNED.items():
        yield Comparison(TABLE, f"{name}, unpruned", published, _unpruned(spec), "kB", OURS_IS)
    found = measured()
    for name, (_, rate) in PRUNED.items():
        for coding, published in PAPER[name].items():
            ours = found[f"{name} float32"][coding]
            what = f"{name}, {rate:.1%} pruned, {coding.upper()}"
            yield Comparison(TABLE, what, published / 1e3, ours / 1e3, "kB", OURS_IS)


def _unpruned(spec: NetworkSpec) -> float:
    return stored(pruned(spec, 0.0, np.float32), "dense") / 1e3
