"""Which weights to prune (paper, section 4.3): pure functions (weights, mask, rate) -> mask.

A mask has a boolean array for every weight matrix of a network, by its name; False is pruned.
`rate` is the share of all weights of the matrices that the new mask prunes, rounded down, so that a
series of rising rates gives masks each within the one before. Biases and embeddings are not pruned.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import BoolArray, Float32Array
from nispcodec.core.errors import NispError
from nispcodec.core.network import NetworkSpec

Mask = Mapping[str, BoolArray]
Strategy = Callable[[Mapping[str, Float32Array], Mask, float], Mask]

NETWORKS = ("sdf", "chart", "uv")


def smallest(weights: Mapping[str, Float32Array], mask: Mask, rate: float) -> Mask:
    """Prune the smallest of each matrix."""
    return {name: _without_smallest(weights[name], kept, rate) for name, kept in mask.items()}


def smallest_global(weights: Mapping[str, Float32Array], mask: Mask, rate: float) -> Mask:
    """Prune the smallest of all matrices together."""
    joined = np.concatenate([weights[name].ravel() for name in mask])
    kept = np.concatenate([each.ravel() for each in mask.values()])
    ends = np.cumsum([each.size for each in mask.values()])[:-1]
    parts = np.split(_without_smallest(joined, kept, rate), ends)
    return {
        name: part.reshape(each.shape)
        for (name, each), part in zip(mask.items(), parts, strict=True)
    }


def large_final(weights: Mapping[str, Float32Array], mask: Mask, rate: float) -> Mask:
    """Keep the largest of each matrix; `weights` are the unpruned network's, whatever the round."""
    return smallest(weights, mask, rate)


STRATEGIES: dict[str, Strategy] = {
    "smallest": smallest,
    "smallest_global": smallest_global,
    "large_final": large_final,
}


@dataclass(frozen=True)
class Pruning:
    """Prune a network by a strategy, in so many rounds, until `rate` of its weights are gone."""

    strategy: str
    rate: float
    rounds: int

    @property
    def rates(self) -> list[float]:
        """The rate after each round; every round prunes the same share of what is left.

        One round for `large_final`, to which more rounds would not matter.
        """
        rounds = 1 if self.strategy == "large_final" else self.rounds
        left = 1 - self.rate
        return [1 - left ** (number / rounds) for number in range(1, rounds)] + [self.rate]


def prunings(strategy: str, rate: float | Mapping[str, float], rounds: int) -> dict[str, Pruning]:
    """The pruning of each network, from one rate for all or a rate by the name of each.

    Raises NispError for a strategy, a network or a rate that makes no sense.
    """
    if strategy not in STRATEGIES:
        raise NispError(f"prune: expected one of {', '.join(STRATEGIES)}, found {strategy!r}")
    if rounds < 1:
        raise NispError(f"prune rounds: expected 1 or more, found {rounds}")
    rates = rate if isinstance(rate, Mapping) else dict.fromkeys(NETWORKS, rate)
    for name, each in rates.items():
        if name not in NETWORKS:
            raise NispError(f"prune rate: expected {', '.join(NETWORKS)}, found {name!r}")
        if not 0 <= each < 1:
            raise NispError(f"prune rate of {name}: expected 0 to below 1, found {each:g}")
    return {name: Pruning(strategy, each, rounds) for name, each in rates.items() if each > 0}


def everything(spec: NetworkSpec) -> Mask:
    """The mask that prunes nothing."""
    return {
        name: np.ones(shape, np.bool_)
        for name, shape in spec.shapes.items()
        if name.startswith("weight.")
    }


def density(mask: Mask) -> float:
    """The share that a mask keeps."""
    return sum(int(kept.sum()) for kept in mask.values()) / sum(kept.size for kept in mask.values())


def _without_smallest(values: Float32Array, mask: BoolArray, rate: float) -> BoolArray:
    sizes = np.where(mask, np.abs(values), -1.0).ravel()
    kept = mask.ravel().copy()
    kept[np.argsort(sizes, kind="stable")[: int(rate * sizes.size)]] = False
    return kept.reshape(mask.shape)
