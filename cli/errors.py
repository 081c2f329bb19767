"""Every error in one style, on standard error: `nisp: error: FILE: expected X, found Y`."""

from __future__ import annotations

import errno
from collections.abc import Iterable

import click

from .extras import needed_extra


class Refused(click.ClickException):
    """Something that the user can mend, in a sentence."""

    exit_code = 2


def explained(error: Exception, command: str) -> str | None:
    """The sentence for an error that the user can mend; None for one of the program itself.

    `command` is the subcommand's name.
    """
    from nispcodec.core.errors import NispError

    if isinstance(error, NispError):
        return str(error)
    if isinstance(error, ImportError):
        return needed_extra(error, command)
    if isinstance(error, OSError) and error.errno != errno.EPIPE:
        return _unusable(error)
    if isinstance(error, MemoryError):
        return f"nisp {command}: expected enough memory, found too little"
    return None


def usage(error: click.ClickException) -> str:
    """What was wrong on the command line, and where to read what is right."""
    context = error.ctx if isinstance(error, click.UsageError) else None
    hint = f" (see {context.command_path} --help)" if context else ""
    return f"{_worded(error)}{hint}"


def warn(warnings: Iterable[str]) -> None:
    """Print each on standard error."""
    for each in warnings:
        click.echo(f"nisp: warning: {each}", err=True)


def _unusable(error: OSError) -> str:
    place = f"{error.filename}: " if error.filename else ""
    return f"{place}expected a file that can be read and written, found: {error.strerror or error}"


def _worded(error: click.ClickException) -> str:
    """What click says, in our words."""
    if isinstance(error, click.NoSuchOption):
        near = f"; did you mean {' or '.join(error.possibilities)}?" if error.possibilities else ""
        return f"{error.option_name}: expected an option of this command, found another{near}"
    if isinstance(error, click.BadOptionUsage):
        return f"{error.option_name}: {_value_expected(error)}"
    if isinstance(error, click.MissingParameter):
        return f"{_name(error)}: expected a value, found none"
    if isinstance(error, click.BadParameter):
        return f"{_name(error)}: {error.message}"
    return error.format_message()


def _value_expected(error: click.BadOptionUsage) -> str:
    takes_none = "does not take a value" in error.message
    return "expected no value, found one" if takes_none else "expected a value, found none"


def _name(error: click.BadParameter) -> str:
    """`-o, --output` or `MODEL`."""
    hint = error.param.get_error_hint(error.ctx) if error.param else error.param_hint or ""
    return str(hint).replace("'", "").replace(" / ", ", ")
