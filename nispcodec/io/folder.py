"""The folder beside an asset: where the files that it names are looked for."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from nispcodec.core.errors import MeshError

# Names of the longest end of a path that is looked for here.
MOST_PARTS = 8
# What Python makes of the bytes of a file's name that are no UTF-8.
_RAW_BYTE = re.compile("[\udc80-\udcff]")


@dataclass(frozen=True)
class Folder:
    """Finds files by the names that artists' tools leave in asset files."""

    path: Path

    def find(self, reference: str) -> Path | None:
        """The file meant by `reference`, or None.

        That at the very path, else that at the longest end of it which is here (`ends_of`).
        """
        places = map(self.exact, (reference, *ends_of(reference)))
        return next((path for path in places if path is not None), None)

    def exact(self, reference: str) -> Path | None:
        """The file at the whole path `reference`, or None.

        Backslashes count as slashes, and neither case nor the way matters in which accents are
        composed.
        """
        parts = parts_of(reference)
        start = Path("/") if Path(reference).is_absolute() else self.path
        return _walk(start, parts) if parts else None

    def beside(self, path: Path) -> Folder:
        """The folder that a file which was found here is in."""
        return Folder(path.parent)

    def read(self, path: Path) -> bytes:
        """The file's bytes. Raises MeshError when it cannot be read."""
        try:
            return path.read_bytes()
        except OSError as why:
            raise MeshError(f"{path}: cannot be read: {why}") from why


def parts_of(reference: str) -> list[str]:
    """The names on the way that a reference goes; backslashes count as slashes."""
    return [part for part in re.split(r"[\\/]+", reference) if part not in ("", ".")]


def ends_of(reference: str) -> list[str]:
    """Where a path from another machine may be here: its ends, the longest first.

    "C:/a/b.png" may be at "a/b.png" or at "b.png".
    """
    parts = parts_of(reference)
    first = len(parts) - min(MOST_PARTS, len(parts) - (not Path(reference).is_absolute()))
    return ["/".join(parts[at:]) for at in range(first, len(parts)) if parts[at] != ".."]


def alike(first: str, second: str) -> bool:
    """Whether names differ in case or composed accents alone, as archives from macOS have it."""
    return _alike(first) == _alike(second)


def _walk(folder: Path, parts: Sequence[str]) -> Path | None:
    """Descend, taking each part exactly or else as `_alike`; only regular files count."""
    found = folder
    for part in parts:
        step = _entry(found, part)
        if step is None:
            return None
        found = step
    return found if found.is_file() else None


def _entry(folder: Path, name: str) -> Path | None:
    if name == "..":
        return folder / name
    try:
        if (folder / name).exists():
            return folder / name
        entries = sorted(folder.iterdir())
    except (OSError, ValueError):  # not a folder, or a name that no file can have
        return None
    return next((entry for entry in entries if alike(entry.name, name)), None)


def readable(name: str) -> str:
    """The name of a file with its bytes that are no UTF-8 as Latin-1, which old archives have."""
    return _RAW_BYTE.sub(lambda byte: chr(ord(byte[0]) - 0xDC00), name)


def composed(name: str) -> str:
    """The name with accents and letters as one character each, as most tools write it."""
    return unicodedata.normalize("NFC", name)


def _alike(name: str) -> str:
    return composed(composed(readable(name)).casefold())
