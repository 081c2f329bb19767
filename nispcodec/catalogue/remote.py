"""Files elsewhere, by URL, through fsspec: S3, GCS, HTTP and many more."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any

from nispcodec.core.errors import MeshError, NispError
from nispcodec.core.extras import require
from nispcodec.io.folder import Folder, alike, parts_of


class Remote:
    """A file system of fsspec, that of a URL; places are URLs of the same kind.

    Object stores show an object when it is whole: there is no temporary one. Raises NispError
    without the extra `remote`, and for a kind of URL that nothing installed knows.
    """

    def __init__(self, url: str) -> None:
        require("fsspec", extra="remote", what_for="a URL")
        from fsspec.core import url_to_fs

        try:
            self.files: Any = url_to_fs(url)[0]
        except (ImportError, ValueError) as why:
            raise NispError(f"{url}: expected a URL that fsspec can open, found: {why}") from why

    def read(self, place: str) -> bytes:
        """All bytes."""
        data: bytes = self.files.cat_file(self._path(place))
        return data

    def write(self, place: str, data: bytes) -> None:
        """In one piece."""
        path = self._path(place)
        self.files.makedirs(self.files._parent(path), exist_ok=True)
        self.files.pipe_file(path, data)

    def folder(self, place: str) -> Folder:
        """The folder that the URL has before its last slash."""
        return RemoteFolder(Path(self._path(place)).parent, self.files)

    def found(self, place: str) -> Iterator[tuple[str, int]]:
        """URL and bytes of the file at a place, of all files below it, or of those a glob means."""
        path = self._path(place)
        glob = any(each in path for each in "*?[")
        listed = self.files.glob(path, detail=True) if glob else self.files.find(path, detail=True)
        for name, facts in sorted(listed.items()):
            if facts.get("type") == "file":
                yield self.files.unstrip_protocol(name), int(facts.get("size") or 0)

    def _path(self, place: str) -> str:
        path: str = self.files._strip_protocol(place)
        return path


@dataclass(frozen=True)
class RemoteFolder(Folder):
    """As `Folder`, of a file system of fsspec: every step costs a question to it."""

    files: Any

    def exact(self, reference: str) -> Path | None:
        """The file at the path `reference`, or None; found as in a folder of the disk."""
        parts = parts_of(reference)
        return self._walk(parts) if parts else None

    def beside(self, path: Path) -> Folder:
        """The folder that a file is in."""
        return RemoteFolder(path.parent, self.files)

    def read(self, path: Path) -> bytes:
        """The file's bytes. Raises MeshError when it cannot be read."""
        try:
            data: bytes = self.files.cat_file(path.as_posix())
        except OSError as why:
            raise MeshError(f"{path}: cannot be read: {why}") from why
        return data

    def _walk(self, parts: list[str]) -> Path | None:
        exact = self.path.joinpath(*parts)
        if ".." not in parts and self.files.isfile(exact.as_posix()):
            return exact
        found = self.path
        for part in parts:
            step = found.parent if part == ".." else self._entry(found, part)
            if step is None:
                return None
            found = step
        return found if self.files.isfile(found.as_posix()) else None

    def _entry(self, folder: Path, name: str) -> Path | None:
        try:
            listed = self.files.ls(folder.as_posix(), detail=False)
        except OSError:
            return None
        names = sorted(PurePosixPath(each).name for each in listed)
        found = name if name in names else next((each for each in names if alike(each, name)), None)
        return None if found is None else folder / found
