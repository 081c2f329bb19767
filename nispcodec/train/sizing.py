"""How large an asset's networks are: by short probes, and a model measured on eight assets.

Every network is probed on its own: a small one learns for `TrainConfig.probe_steps`, and the error
that it is left with says how much there is to learn.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

from nispcodec.core.network import NetworkSpec
from nispcodec.train.config import SizingConfig

Hidden = Mapping[str, tuple[int, ...]]
"""Widths of the hidden layers, by the name of the network."""


def hidden_layers(
    errors: Mapping[str, float],
    area: float,
    scale: float = 1.0,
    config: SizingConfig = SizingConfig(),
) -> Hidden:
    """The hidden layers of every network, from the held-out errors of the probes.

    `area` is the surface's, in the normalized frame; widths are `scale` times as large.
    """
    widths = {name: config.models[name].of(error) for name, error in errors.items()}
    widths["sdf"] *= max(1.0, area / config.area) ** config.area_power
    fine = is_fine(errors, config)
    if fine:
        widths["sdf"] = config.fine_width
    count = config.fine_layers if fine else config.layers
    return {name: layers(scale * width, count, config) for name, width in widths.items()}


def is_fine(errors: Mapping[str, float], config: SizingConfig) -> bool:
    """Whether an asset is of fine detail: its SDF is wider, deeper, and learns slower."""
    return errors["sdf"] > config.fine


def foreseen(error: float, probe: Sequence[int], hidden: Sequence[int]) -> float:
    """The held-out error that a longer fit should end below, from that of its probe.

    By the width of the first hidden layers: a fit of a wider network should at least gain what its
    width does, which is about in proportion. That it is longer should help it further.
    """
    return error * probe[0] / hidden[0]


def smallest(names: Iterable[str], config: SizingConfig = SizingConfig()) -> Hidden:
    """The least hidden layers that these networks are given."""
    return {name: layers(config.narrowest, config.layers, config) for name in names}


def layers(width: float, count: int, config: SizingConfig = SizingConfig()) -> tuple[int, ...]:
    """So many hidden layers of the width nearest to `width` that they may have."""
    return (even_width(width, config),) * count


def even_width(width: float, config: SizingConfig = SizingConfig()) -> int:
    """The nearest width that networks may have."""
    nearest = config.multiple * round(width / config.multiple)
    return min(max(nearest, config.narrowest), config.widest)


def bits_of(
    specs: Mapping[str, NetworkSpec], config: SizingConfig = SizingConfig()
) -> dict[str, float]:
    """Bits that the weights of each network take in the file at the default lambda."""
    return {name: spec.weight_count * config.bits[name] for name, spec in specs.items()}


def bytes_of(specs: Mapping[str, NetworkSpec], config: SizingConfig = SizingConfig()) -> float:
    """The same for all networks together, in bytes."""
    return sum(bits_of(specs, config).values()) / 8


def scale_for_bytes(size: Callable[[float], float], wanted: float) -> float:
    """The scale at which `size(scale)`, which never falls, reaches `wanted` bytes."""
    low, high = 0.0, 8.0
    for _ in range(20):
        middle = (low + high) / 2
        low, high = (low, middle) if size(middle) >= wanted else (middle, high)
    return high
