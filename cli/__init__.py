"""The `nisp` command: one file a subcommand, loaded when it is asked for.

Nothing here imports numpy at the top of a module, so that `nisp --help` answers at once.
"""

from __future__ import annotations

import importlib
import sys
from difflib import get_close_matches
from typing import Any

import click

from .ending import Terminated, ending_on_sigterm
from .errors import Refused, explained, usage

COMMANDS = (
    "encode",
    "batch",
    "decode",
    "render",
    "sheet",
    "view",
    "info",
    "verify",
    "recode",
    "unpack",
    "retexture",
    "compare",
    "query",
    "sample",
)


_WHOLE = "files are written whole or not at all"


class LazyGroup(click.Group):
    """Finds each subcommand in the module of its name; turns errors into exit codes."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """The commands in the order of COMMANDS."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The `command` of the module of that name."""
        if cmd_name not in COMMANDS:
            return None
        command: click.Command = importlib.import_module(f".{cmd_name}", __package__).command
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """The command that is named. Raises UsageError for another name."""
        if args[0] not in COMMANDS and not args[0].startswith("-"):
            near = get_close_matches(args[0], COMMANDS, 1)
            meant = f"; did you mean {near[0]}?" if near else ""
            known = ", ".join(COMMANDS)
            said = f"command: expected one of {known}, found {args[0]!r}{meant}"
            raise click.UsageError(said, ctx)
        return super().resolve_command(ctx, args)

    def invoke(self, ctx: click.Context) -> Any:
        """Run; what the user can mend becomes `Refused`."""
        try:
            return super().invoke(ctx)
        except Exception as error:
            said = explained(error, ctx.invoked_subcommand or "")
            if said is None:
                raise
            raise Refused(said) from error

    def main(self, *args: Any, **kwargs: Any) -> Any:
        """Run and exit: 0, what the command says, or 2 with one line on standard error.

        Ctrl-C exits with 130 and SIGTERM with 143, as shells have it.
        """
        try:
            with ending_on_sigterm():
                code = super().main(*args, **{**kwargs, "standalone_mode": False})
        except click.Abort as why:  # which click makes of Ctrl-C, and of the end of an input
            if not isinstance(why.__cause__, KeyboardInterrupt):
                raise
            click.echo(f"nisp: interrupted; {_WHOLE}", err=True)
            sys.exit(130)
        except Terminated:
            click.echo(f"nisp: terminated; {_WHOLE}", err=True)
            sys.exit(143)
        except click.exceptions.NoArgsIsHelpError as error:
            error.show()
            sys.exit(error.exit_code)
        except click.ClickException as error:
            click.echo(f"nisp: error: {usage(error)}", err=True)
            sys.exit(2)
        sys.exit(code if isinstance(code, int) else 0)


@click.group(
    "nisp",
    cls=LazyGroup,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog="Exit codes: 0 done, 1 `verify` found a fault, 2 an error, 3 `batch` had failures, "
    "130 interrupted, 143 terminated.",
)
@click.version_option(package_name="nispcodec", message="%(prog)s %(version)s")
def main() -> None:
    """Textured 3D assets as a few kilobytes of network weights.

    \b
    nisp sample -o demo                      make an asset to play with
    nisp encode demo/sample.obj -o s.nisp    fit, quantize, write
    nisp decode s.nisp -o s.glb              textured mesh again
    nisp render s.nisp -o s.png              a picture of it
    nisp view s.nisp                         in the browser
    nisp compare demo/sample.obj s.nisp      what was lost
    """
