"""What is written: refused before the work where it cannot be, or where something is in the way."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .sources import parsed, read_file

if TYPE_CHECKING:
    from nispcodec.core.atomic_write import Writing

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]
Suffixes = Callable[[], Sequence[str]]
"""Asked when first needed: the library knows which formats it writes."""


@dataclass(frozen=True)
class Sink:
    """A file, or standard output where `path` is None."""

    path: Path | None

    @property
    def suffix(self) -> str:
        """That of the file in small letters; "" for standard output."""
        return self.path.suffix.lower() if self.path else ""

    def write(self, writing: Writing) -> None:
        """Let `writing` write all of it; a file whole or not at all."""
        from nispcodec.core.atomic_write import write_atomic

        if self.path:
            write_atomic(self.path, writing)
        else:
            writing(sys.stdout.buffer)
            sys.stdout.buffer.flush()


class OutputFile(click.ParamType):  # type: ignore[type-arg]  # generic in newest click only
    """The path of a file with one of some suffixes, in a folder that can be written."""

    name = "file"

    def __init__(self, suffixes: Suffixes) -> None:
        self.suffixes = suffixes

    def get_metavar(self, param: click.Parameter, ctx: click.Context) -> str:
        """`FILE[.glb|.obj]`, for the help."""
        return f"FILE[{'|'.join(self.suffixes())}]"

    def convert(
        self, value: str | Path, param: click.Parameter | None, ctx: click.Context | None
    ) -> Any:
        """The path. Raises NispError for what cannot be written: its suffix, name or folder."""
        from nispcodec.core.errors import NispError

        path, suffixes = Path(value), self.suffixes()
        expect_fitting_name(path)
        if path.suffix.lower() not in suffixes:
            found = path.suffix or "no suffix"
            raise NispError(f"{path}: expected {', '.join(suffixes)}, found {found}")
        if path.is_dir():
            raise NispError(f"{path}: expected a file to write, found a folder")
        expect_folder(path.parent)
        return path


class OutputOrDash(OutputFile):
    """That, or `-` for standard output."""

    def get_metavar(self, param: click.Parameter, ctx: click.Context) -> str:
        """`FILE[.csv]|-`, for the help."""
        return f"{super().get_metavar(param, ctx)}|-"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """The sink. Raises NispError as `OutputFile` does."""
        if isinstance(value, Sink):
            return value
        return Sink(None if value == "-" else super().convert(value, param, ctx))


def output_option(kind: OutputFile) -> Decorator:
    """The option `-o` for a file.

    Checked before the work, so that no long work is lost for a typing error.
    """
    return click.option("-o", "--output", type=kind, required=True, help="What to write.")


folder_option = click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    required=True,
    metavar="FOLDER",
    help="What to write into; made where it is missing.",
)


def nisp_suffix() -> tuple[str, ...]:
    """That of the files of the format itself."""
    return (".nisp",)


def expect_fitting_name(path: Path) -> None:
    """Raises NispError for a name that is longer than its file system takes."""
    from nispcodec.core.errors import NispError

    try:
        os.lstat(path)
    except OSError as why:
        if why.errno == errno.ENAMETOOLONG:
            found = len(os.fsencode(path.name))
            raise NispError(f"{path}: expected a shorter name, found {found} bytes") from why


def expect_folder(folder: Path) -> None:
    """Raises NispError for a folder that is missing or cannot be written into."""
    from nispcodec.core.errors import NispError

    if not folder.is_dir():
        found = "a file" if folder.exists() else "none"
        raise NispError(f"{folder}: expected a folder to write into, found {found}")
    if not os.access(folder, os.W_OK):
        raise NispError(f"{folder}: expected a folder to write into, found a read-only one")


def make_folder(folder: Path) -> None:
    """Make a folder and those above it. Raises NispError where a file is in the way."""
    from nispcodec.core.errors import NispError

    try:
        folder.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError) as why:
        raise NispError(f"{folder}: expected a folder to write into, found a file") from why


def refuse_overwriting(paths: Iterable[Path], force: bool) -> None:
    """Raises NispError, naming it, where one of the files is there already or its name too long."""
    from nispcodec.core.errors import NispError

    paths = list(paths)
    for path in paths:
        expect_fitting_name(path)
    taken = [] if force else [path for path in paths if os.path.lexists(path)]
    if taken:
        others = f" (and {', '.join(path.name for path in taken[1:])})" if taken[1:] else ""
        raise NispError(
            f"{taken[0]}: expected no file of this name, found one{others}: --force overwrites"
        )


def refuse_overwriting_others(path: Path, force: bool) -> None:
    """As `refuse_overwriting`, but for a sound `.nisp`: an earlier output, made again."""
    from nispcodec.core.errors import NispError

    if force or not os.path.lexists(path):
        return
    try:
        parsed(read_file(path), path)
    except NispError as why:
        wrong = str(why).removeprefix(f"{path}: ")
        raise NispError(
            f"{path}: expected no file of this name or an earlier output, found another "
            f"({wrong}): --force overwrites"
        ) from why


def listed(paths: Iterable[Path]) -> list[dict[str, Any]]:
    """The files with their sizes, as for JSON."""
    return [{"file": str(path), "bytes": path.stat().st_size} for path in paths]
