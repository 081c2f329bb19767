"""A `.nisp` file on disk."""

from __future__ import annotations

from pathlib import Path

from nispcodec.core.atomic_write import expect_path
from nispcodec.core.document import Document
from nispcodec.core.errors import FormatError, NispError
from nispcodec.format.document import unpack


def read(path: str | Path) -> Document:
    """The document in a file.

    Raises FormatError, naming the file, for a malformed one and NispError for an unreadable one.
    """
    expect_path(path)
    try:
        return unpack(Path(path).read_bytes())
    except OSError as why:
        raise NispError(f"{path}: cannot be read: {why}") from why
    except FormatError as error:
        error.file = str(path)
        raise
