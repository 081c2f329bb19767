"""How large an asset's networks should be: by short probes, and a model measured on eight assets.

Every network is probed on its own: a small one learns for a few seconds, and the error that it is
left with says how much there is to learn.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from nispcodec.network import NetworkSpec

Widths = Mapping[str, int]
"""Width of the hidden layers by the name of the network."""

LAYERS = {"sdf": 4, "chart": 3, "uv": 4}
MIN_WIDTH, MAX_WIDTH = 8, 128
MULTIPLE = 2

BITS = {"sdf": 6.8, "chart": 5.2, "uv": 8.0}
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
    "sdf": Model(30, 1.0e-3, 0.7, 22, 36),
    "chart": Model(21, 0.03, 0.4, 18, 48),
    "uv": Model(20, 9.3e-4, 0.6, 12, 40),
}

AREA, AREA_POWER = 5.0, 0.4
"""With the same error left on a larger surface than this (normalised frame) more is to be held."""

FINE, FINE_WIDTH = 1.8e-3, 72
"""An SDF whose probe is left with more is of another kind: wider, and learns slower."""


def widths_for(errors: Mapping[str, float], area: float, scale: float = 1.0) -> Widths:
    """The width of every network, from the held-out errors of the probes, times `scale`.

    `area` is the surface's, in the normalised frame.
    """
    widths = {name: MODELS[name].of(error) for name, error in errors.items()}
    widths["sdf"] *= max(1.0, area / AREA) ** AREA_POWER
    if errors["sdf"] > FINE:
        widths["sdf"] = FINE_WIDTH
    return {name: even_width(scale * width) for name, width in widths.items()}


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
