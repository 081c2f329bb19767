"""`python -m nispcodec` is `nisp`."""

from __future__ import annotations

import sys
from importlib import import_module

COMMAND_LINE = "nispcodec_cli"


def main() -> None:
    """Run the command line; exit with 2, and one sentence, where it is not installed."""
    try:
        command = import_module(COMMAND_LINE).main
    except ModuleNotFoundError as error:
        if error.name not in (COMMAND_LINE, "click"):
            raise
        said = f"the command line needs {error.name}, found none: pip install nispcodec"
        sys.stderr.write(f"nisp: error: {said}\n")
        sys.exit(2)
    command(prog_name="nisp")


if __name__ == "__main__":
    main()
