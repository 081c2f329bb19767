"""Numbers within bounds, refused in our words."""

from __future__ import annotations

from math import isnan
from typing import Any

import click


class Whole(click.IntRange):
    """A whole number from `min` to `max`, where these are given."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """The number."""
        try:
            return super().convert(value, param, ctx)
        except click.BadParameter:
            self.fail(f"expected a whole number{_bounds(self)}, found {str(value)!r}", param, ctx)


class Real(click.FloatRange):
    """A number from `min` to `max`, where these are given, and never NaN."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """The number."""
        try:
            number = super().convert(value, param, ctx)
        except click.BadParameter:
            number = float("nan")
        if isnan(number):
            self.fail(f"expected a number{_bounds(self)}, found {str(value)!r}", param, ctx)
        return number


def _bounds(of: Whole | Real) -> str:
    if of.min is None:
        return ""
    if of.max is not None:
        return f" from {of.min} to {of.max}"
    return f" above {of.min}" if of.min_open else f" of {of.min} or more"
