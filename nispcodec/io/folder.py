"""The folder beside an asset: where the files that it names are looked for."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from nispcodec.core.errors import MeshError


@dataclass(frozen=True)
class Folder:
    """Finds files by the names that artists' tools leave in asset files."""

    path: Path

    def find(self, reference: str) -> Path | None:
        """The file meant by `reference`, or None.

        Backslashes count as slashes, and neither case nor the way matters in which accents are
        composed. A path from another machine falls back to its last part, beside the asset.
        """
        parts = parts_of(reference)
        if not parts:
            return None
        start = Path("/") if Path(reference).is_absolute() else self.path
        return _walk(start, parts) or _walk(self.path, parts[-1:])

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


def composed(name: str) -> str:
    """The name with accents and letters as one character each, as most tools write it."""
    return unicodedata.normalize("NFC", name)


def _alike(name: str) -> str:
    return composed(composed(name).casefold())
