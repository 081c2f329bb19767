"""Write docs/options.md from what `nisp COMMAND --help` says.

python docs/options.py           rewrites the page
python docs/options.py --check   exits with 1 where the page is stale
"""

from __future__ import annotations

import sys
from pathlib import Path

import click
from nispcodec_cli import COMMANDS
from nispcodec_cli import main as nisp

PAGE = Path(__file__).parent / "options.md"
HEAD = """# Options

Every command of `nisp` and what it takes, as `nisp COMMAND --help` says it.
This page is written by `python docs/options.py`.
[quickstart.md](quickstart.md) shows the commands at work, [limits.md](limits.md) says which option
helps when.

A file that is there is overwritten only with `--force`. Errors are one line:
`nisp: error: FILE: expected X, found Y`. `-` is standard input where it says so, and `--json`
prints the result for programs and nothing else.
"""


def page() -> str:
    """The page's text."""
    return "\n".join([HEAD, *map(section, COMMANDS)])


def section(name: str) -> str:
    """A command: what it does, and a table of its options."""
    context = click.Context(nisp, info_name="nisp", terminal_width=100)
    command = nisp.get_command(context, name)
    assert command is not None
    own = click.Context(command, info_name=name, parent=context, terminal_width=100)
    usage = " ".join(command.collect_usage_pieces(own))
    options = [each for each in command.params if isinstance(each, click.Option)]
    records = [record for each in options if (record := each.get_help_record(own))]
    rows = "\n".join(f"| `{cell(names)}` | {cell(said)} |" for names, said in records)
    text = (command.help or "").replace("\b\n", "").strip()
    table = f"| option | what it does |\n| --- | --- |\n{rows}\n"
    return f"## nisp {name}\n\n    nisp {name} {usage}\n\n{paragraphs(text)}\n\n{table}"


def paragraphs(text: str) -> str:
    """Help in Markdown: an example stays as it is written."""
    parts = text.split("\n\n")
    written = (indented(part) if "nisp " in part else " ".join(part.split()) for part in parts)
    return "\n\n".join(written)


def indented(part: str) -> str:
    """A block of code."""
    lines = [line.strip().removeprefix("Example: ") for line in part.splitlines()]
    return "\n".join(f"    {line}" for line in lines)


def cell(text: str) -> str:
    """Text that ends no cell of a table."""
    return " ".join(text.split()).replace("|", "\\|").replace("<", "&lt;")


def main(arguments: list[str]) -> int:
    """Rewrite or check; returns the exit code."""
    fresh = page()
    if "--check" not in arguments:
        PAGE.write_text(fresh, encoding="utf-8")
        return 0
    stale = not PAGE.exists() or PAGE.read_text(encoding="utf-8") != fresh
    if stale:
        print("docs/options.md is stale: python docs/options.py", file=sys.stderr)
    return int(stale)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
