"""What is read: a `.nisp` from a file or standard input, a mesh from a file."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

import click

if TYPE_CHECKING:
    from nispcodec.catalogue.inputs import InputBytes
    from nispcodec.core.asset import TexturedMesh
    from nispcodec.core.document import Document

SHOWN = 16
"""Bytes of a file that is no `.nisp` which an error shows."""


@dataclass(frozen=True)
class Source:
    """A file, or standard input where `path` is None."""

    path: Path | None

    def __str__(self) -> str:
        return str(self.path) if self.path else "standard input"

    def read(self) -> bytes:
        """All bytes. Raises NispError, in words, for what cannot be read."""
        return read_file(self.path) if self.path else sys.stdin.buffer.read()

    @contextmanager
    def opened(self) -> Iterator[BinaryIO]:
        """All bytes, to be read. Raises NispError, in words, for what cannot be read."""
        if self.path is None:
            yield sys.stdin.buffer
            return
        with _in_words(self.path), self.path.open("rb") as file:
            yield file


class SourceFile(click.ParamType):  # type: ignore[type-arg]  # generic in newest click only
    """A file's path, or `-` for standard input."""

    name = "file"

    def convert(
        self, value: str | Source, param: click.Parameter | None, ctx: click.Context | None
    ) -> Source:
        """`-` or a path."""
        if isinstance(value, Source):
            return value
        return Source(None if value == "-" else Path(value))


model_argument = click.argument("model", type=SourceFile())


def read_file(path: Path) -> bytes:
    """The bytes of a file. Raises NispError for a missing one, a folder, or no permission."""
    with _in_words(path):
        return path.read_bytes()


@contextmanager
def _in_words(path: Path) -> Iterator[None]:
    """Turn what the system says of a file that cannot be read into NispError."""
    from nispcodec.core.errors import NispError

    try:
        yield
    except FileNotFoundError as why:
        raise NispError(f"{path}: expected a file, found none") from why
    except IsADirectoryError as why:
        raise NispError(f"{path}: expected a file, found a folder") from why
    except OSError as why:
        raise NispError(f"{path}: expected a file that can be read, found: {why.strerror}") from why


def parsed(data: bytes, name: object) -> Document:
    """The document of a `.nisp` file's bytes.

    Raises NispError for what is no `.nisp` at all, FormatError for a malformed one; both say the
    `name`.
    """
    from nispcodec.core.errors import FormatError, NispError
    from nispcodec.format import unpack

    if wrong := no_nisp(data):
        raise NispError(f"{name}: {wrong}{_way_out(str(name))}")
    try:
        return unpack(data)
    except FormatError as error:
        error.file = str(name)
        raise


def no_nisp(data: bytes) -> str:
    """What is said of bytes that are no `.nisp` file; "" of those that begin like one."""
    from nispcodec.format.constants import SIGNATURE

    head = data[: len(SIGNATURE)]
    if not head:
        return "this is no .nisp file: expected some bytes, found an empty file"
    if SIGNATURE.startswith(head):
        return ""
    return f"this is no .nisp file: expected {SIGNATURE[:4]!r} first, found {_beginning(data)}"


def _way_out(name: str) -> str:
    """What makes a `.nisp` of a mesh file; "" for other names."""
    from nispcodec.io.load import READERS

    is_mesh = Path(name).suffix.lower() in READERS
    return ": `nisp encode` makes one of a mesh" if is_mesh else ""


def is_nisp(path: Path) -> bool:
    """Whether a file is meant as a `.nisp`, by its name or its first bytes."""
    from nispcodec.format.constants import SIGNATURE

    if path.suffix.lower() == ".nisp":
        return True
    try:
        with path.open("rb") as file:
            return file.read(len(SIGNATURE)) == SIGNATURE
    except OSError:
        return False


def read_mesh(path: Path) -> TexturedMesh:
    """The mesh in a file. Raises NispError in words for what is none, MeshError for a bad one."""
    from nispcodec.io.load import load_mesh

    _expect_mesh(path)
    return load_mesh(path)


def read_counted(path: Path) -> tuple[TexturedMesh, InputBytes]:
    """As `read_mesh`, and the bytes of all that was read. Raises what that raises."""
    from nispcodec.catalogue.inputs import read_noted

    _expect_mesh(path)
    mesh, _, read = read_noted(str(path))
    return mesh, read


def _expect_mesh(path: Path) -> None:
    from nispcodec.core.errors import NispError
    from nispcodec.io.load import READERS

    if str(path) == "-":
        raise NispError(f"{path}: expected a file, found standard input: a name says what it is")
    if is_nisp(path):
        wanted = f"{path}: expected a mesh file ({' '.join(READERS)})"
        raise NispError(f"{wanted}, found a .nisp file: `nisp decode` makes a mesh of it")
    if path.is_dir():
        wanted = f"{path}: expected a file, found a folder"
        raise NispError(f"{wanted}: `nisp batch` encodes all that is in one")
    if path.suffix.lower() in READERS:
        with _in_words(path), path.open("rb"):
            pass


def _beginning(data: bytes) -> str:
    """The first bytes as people read them: a text's first line, else as Python writes bytes."""
    head = data[:SHOWN]
    line = head.splitlines()[0] if head.strip() else head
    return repr(line.decode()) if line.isascii() and line.decode().isprintable() else repr(head)
