"""The options of `nisp encode` that prune."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

from .choices import LibraryChoice, pruning_strategies
from .ranges import Whole

Command = TypeVar("Command", bound=Callable[..., Any])


def pruning_options(command: Command) -> Command:
    """`--prune`, `--prune-rate`, `--prune-rounds`."""
    for option in (_rounds, _rate, _strategy):
        command = option(command)
    return command


def _parsed(
    context: click.Context, parameter: click.Parameter, value: str
) -> float | dict[str, float]:
    """A rate for all networks, or by name: what is not named is not pruned."""
    given = context.get_parameter_source("prune_rate") is click.core.ParameterSource.COMMANDLINE
    if given and not context.params.get("prune"):
        raise click.UsageError("--prune-rate: expected --prune beside it, found it alone")
    try:
        if "=" not in value:
            return float(value)
        pairs = [each.split("=") for each in value.split(",")]
        return {name.strip(): float(rate) for name, rate in pairs}
    except ValueError as why:
        said = f"expected 0.5 or sdf=0.5,chart=0.6,uv=0.4, found {value!r}"
        raise click.BadParameter(said, context, parameter) from why


_strategy = click.option(
    "--prune",
    type=LibraryChoice(pruning_strategies),
    is_eager=True,
    help="Lottery tickets: train, prune, rewind, train again.",
)
_rate = click.option(
    "--prune-rate",
    default="0.5",
    show_default=True,
    callback=_parsed,
    metavar="RATE",
    help="Share of the weights to prune; or by network: sdf=0.3,uv=0.5.",
)
_rounds = click.option(
    "--prune-rounds",
    type=Whole(1),
    default=2,
    show_default=True,
    help="Until the rate is reached; each takes as long as an encode.",
)
