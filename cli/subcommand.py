"""What every subcommand has in common."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import click


class Subcommand(click.Command):
    """Names the first argument that is too much, in our words."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """The arguments that are left: none. Raises UsageError where there are some."""
        ctx.allow_extra_args = True
        rest = super().parse_args(ctx, args)
        if rest and not ctx.resilient_parsing:
            raise click.UsageError(f"{rest[0]}: expected nothing more, found an argument", ctx)
        return rest


def subcommand(name: str, short_help: str) -> Callable[[Callable[..., Any]], click.Command]:
    """The decorator that makes a function a subcommand; its docstring is the help."""
    return click.command(name, cls=Subcommand, short_help=short_help)


json_option = click.option(
    "--json", "as_json", is_flag=True, help="The result as JSON on standard output."
)
force_option = click.option("--force", is_flag=True, help="Overwrite files that are there.")
