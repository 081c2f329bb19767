"""How large an asset's networks should be: by short probes, and a model measured on eight assets.

Every network is probed on its own: a small one learns for a few seconds, and the error that it is
left with says how much there is to learn.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from nispcodec.core.network import NetworkSpec

Hidden = Mapping[str, tuple[int, ...]]
"""Widths of the hidden layers, by the name of the network."""

LAYERS = 4
MIN_WIDTH, MAX_WIDTH = 8, 128
MULTIPLE = 2

BITS = {"sdf": 7.0, "chart": 6.4, "uv": 8.6}
"""About what a weight takes in the file at the default price: medians of eight assets."""


@dataclass(frozen=True)
class Model:
    """Width = `width` (error of the probe / `error`)^`power`, within `lowest` and `highest`."""

    width: float
    error: float
    power: float
    lowest: int
    highest: int

    def of(self, error: float) -> float:
        """The width for a probe that is left with `error`."""
        width = self.width * (error / self.error) ** self.power
        return min(max(width, self.lowest), self.highest)


MODELS = {
    "sdf": Model(33, 1.0e-3, 0.7, 22, 34),
    "chart": Model(30, 0.056, 0.6, 16, 44),
    "uv": Model(19.5, 9.3e-4, 0.6, 12, 34),
}

AREA, AREA_POWER = 5.0, 0.4
"""With the same error left on a larger surface than this (normalized frame) more is to be held."""

FINE, FINE_WIDTH = 1.8e-3, 66
"""An SDF whose probe is left with more is of fine detail: wider, and learns slower."""

DEEP = 5
"""Layers of all networks of such an asset."""


def hidden_layers(errors: Mapping[str, float], area: float, scale: float = 1.0) -> Hidden:
    """The hidden layers of every network, from the held-out errors of the probes.

    `area` is the surface's, in the normalized frame; widths are `scale` times as large.
    """
    widths = {name: MODELS[name].of(error) for name, error in errors.items()}
    widths["sdf"] *= max(1.0, area / AREA) ** AREA_POWER
    fine = errors["sdf"] > FINE
    if fine:
        widths["sdf"] = FINE_WIDTH
    count = DEEP if fine else LAYERS
    return {name: layers(scale * width, count) for name, width in widths.items()}


def smallest(names: Iterable[str]) -> Hidden:
    """The least hidden layers that these networks are given."""
    return {name: layers(MIN_WIDTH) for name in names}


def layers(width: float, count: int = LAYERS) -> tuple[int, ...]:
    """So many hidden layers of the width nearest to `width` that they may have."""
    return (even_width(width),) * count


def even_width(width: float) -> int:
    """The nearest width that networks may have."""
    return min(max(MULTIPLE * round(width / MULTIPLE), MIN_WIDTH), MAX_WIDTH)


def bits_of(specs: Mapping[str, NetworkSpec]) -> dict[str, float]:
    """What the weights of each network take in the file at the default price."""
    return {name: spec.weight_count * BITS[name] for name, spec in specs.items()}


def bytes_of(specs: Mapping[str, NetworkSpec]) -> float:
    """The same for all networks together, in bytes."""
    return sum(bits_of(specs).values()) / 8


def scale_for_bytes(size: Callable[[float], float], wanted: float) -> float:
    """The scale at which `size(scale)`, which never falls, reaches `wanted` bytes."""
    low, high = 0.0, 8.0
    for _ in range(20):
        middle = (low + high) / 2
        low, high = (low, middle) if size(middle) >= wanted else (middle, high)
    return high
