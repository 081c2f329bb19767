"""Storage: where assets are read from and outputs written to, this machine's disks or elsewhere."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Protocol

from nispcodec.core.atomic_write import write_atomic
from nispcodec.core.errors import NispError
from nispcodec.io.folder import Folder


class Storage(Protocol):
    """Reads and writes whole files by path or URL."""

    def read(self, place: str) -> bytes:
        """All bytes. Raises OSError where there is no such file, or it cannot be read."""
        ...

    def write(self, place: str, data: bytes) -> None:
        """Write a file, whole or not at all, and the folders above it.

        Raises OSError or NispError where it cannot be written.
        """
        ...

    def folder(self, place: str) -> Folder:
        """The folder of a file, which finds what that file names."""
        ...


class Local:
    """Files of this machine."""

    def read(self, place: str) -> bytes:
        """All bytes."""
        return Path(place).read_bytes()

    def write(self, place: str, data: bytes) -> None:
        """By a temporary file beside it, which is renamed."""
        path = Path(place)
        path.parent.mkdir(parents=True, exist_ok=True)
        write_atomic(path, data)

    def folder(self, place: str) -> Folder:
        """The folder on the disk."""
        return Folder(Path(place).parent)


def is_remote(place: str) -> bool:
    """Whether a place is a URL such as s3://bucket/name."""
    return "://" in place


def storage_of(place: str) -> Storage:
    """The storage of a path or URL. Raises NispError for a URL without the extra `remote`."""
    if not is_remote(place):
        return Local()
    from nispcodec.catalogue.remote import Remote

    return Remote(place)


def joined(folder: str, name: str) -> str:
    """The place of a file in a folder, by its name relative to it, with slashes.

    Raises NispError for a name that leaves the folder: names come from files, too.
    """
    parts = name.split("/")
    if not name or name.startswith("/") or {"", ".", ".."} & set(parts) or "\0" in name:
        raise NispError(f"{name!r}: expected a path within the folder of the outputs")
    if is_remote(folder):
        return "/".join([folder.rstrip("/"), *parts])
    return os.path.join(folder, *parts)  # noqa: PTH118, as names need not be UTF-8


def full_disk(error: BaseException | None) -> bool:
    """Whether an error, or what it came from, says that the disk or the quota is full."""
    import errno

    while error is not None:
        if isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT):
            return True
        error = error.__cause__
    return False
