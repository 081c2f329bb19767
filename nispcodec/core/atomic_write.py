"""Files are written whole or not at all."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO

from nispcodec.core.errors import NispError

Writing = Callable[[BinaryIO], object]


def write_atomic(path: Path, data: bytes | Writing) -> None:
    """Write to a temporary file beside `path`, flush it to disk, rename it over `path`.

    `data` are the bytes, or what writes them into the file that it is given. Permissions are those
    of a new file. Raises NispError, and leaves what was there, when the folder cannot be written,
    or `path` has a character that no path can have.
    """
    expect_path(path)
    try:
        # A name of its own, as that of `path` may be as long as names can be.
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=".nisp-", suffix=".part")
    except OSError as why:
        raise NispError(f"{path}: cannot be written: {why.strerror}") from why
    temporary = Path(name)
    try:
        with os.fdopen(handle, "wb") as file:
            if isinstance(data, bytes):
                file.write(data)
            else:
                data(file)
            file.flush()
            os.fsync(file.fileno())
        temporary.chmod(0o666 & ~_umask())
        temporary.replace(path)
    except OSError as why:
        raise NispError(f"{path}: cannot be written: {why.strerror}") from why
    finally:
        temporary.unlink(missing_ok=True)


def expect_path(path: str | Path) -> None:
    """Raises NispError for a path with NUL, which no file system has, and no call of it takes."""
    if "\0" in str(path):
        raise NispError(f"{str(path)!r}: expected a path without NUL, found one with it")


def _umask() -> int:
    """The process's umask, which can only be read by setting it."""
    mask = os.umask(0)
    os.umask(mask)
    return mask
