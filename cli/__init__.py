"""The `nisp` command: one file a subcommand, loaded when it is asked for.

Nothing here imports numpy at the top of a module, so that `nisp --help` answers at once.
"""

from __future__ import annotations

import errno
import importlib
from typing import Any

import click

COMMANDS = (
    "encode",
    "decode",
    "render",
    "sheet",
    "info",
    "verify",
    "recode",
    "unpack",
    "retexture",
    "compare",
    "query",
    "sample",
)


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

    def invoke(self, ctx: click.Context) -> Any:
        """Run; errors that the user can mend exit with 2, Ctrl-C with 130."""
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            click.echo("nisp: interrupted, nothing written", err=True)
            ctx.exit(130)
        except Exception as error:
            click.echo(f"nisp: error: {_explained(error)}", err=True)
            ctx.exit(2)


def _explained(error: Exception) -> str:
    """The text for an error the user can mend; raises any other again."""
    from nispcodec.core.errors import NispError

    if isinstance(error, OSError) and error.errno != errno.EPIPE:
        return f"{error.filename}: {error.strerror}" if error.filename else str(error)
    if isinstance(error, NispError):
        return str(error)
    raise error


@click.group(cls=LazyGroup, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="nispcodec", message="%(prog)s %(version)s")
def main() -> None:
    """Textured 3D assets as a few kilobytes of network weights.

    \b
    nisp sample -o demo                      make an asset to play with
    nisp encode demo/sample.obj -o s.nisp    fit, quantize, write
    nisp decode s.nisp -o s.glb              textured mesh again
    nisp render s.nisp -o s.png              a picture of it
    nisp compare demo/sample.obj s.nisp      what was lost
    """
