"""The inputs of an asset: a hash of every file it was read from, to see whether one has changed."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from nispcodec.catalogue.storage import storage_of
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.errors import MeshError
from nispcodec.io.folder import Folder
from nispcodec.io.load import parse_mesh, reader_of

Inputs = dict[str, str | None]

OF_THE_MESH = (".bin", ".mtl")
"""Suffixes of what is read beside an asset's file and is no image."""


@dataclass(frozen=True)
class InputBytes:
    """Bytes on disk: of the file with its buffers and material library, and of images beside it."""

    mesh: int
    textures: int


@dataclass(frozen=True)
class NotedFolder(Folder):
    """A folder that notes what is found, read and missed in it, relative to `top`."""

    inner: Folder
    top: Path
    notes: Inputs = field(repr=False)
    sizes: dict[str, int] = field(repr=False)

    def exact(self, reference: str) -> Path | None:
        """As the folder within."""
        found = self.inner.exact(reference)
        if found is None and reference:
            self.notes.setdefault(os.path.join(self._way(self.path), reference), None)  # noqa: PTH118
        return found

    def beside(self, path: Path) -> Folder:
        """The same of another folder."""
        return replace(self, path=path.parent, inner=self.inner.beside(path))

    def read(self, path: Path) -> bytes:
        """As the folder within. Raises MeshError when the file cannot be read."""
        data = self.inner.read(path)
        self.notes[self._way(path)] = sha256(data)
        self.sizes[self._way(path)] = len(data)
        return data

    def _way(self, path: Path) -> str:
        way = os.path.relpath(path, self.top)
        return "" if way == "." else way


def read_noted(source: str) -> tuple[TexturedMesh, Inputs, InputBytes]:
    """The mesh in a file, as `load_mesh` gives it, what it was read from, and how much that is.

    Raises MeshError for a file that cannot be read or makes no sense.
    """
    path, storage = Path(source), storage_of(source)
    reader_of(path)
    try:
        data = storage.read(source)
    except FileNotFoundError as why:
        raise MeshError(f"{source}: expected a file, found none") from why
    inner = storage.folder(source)
    notes: Inputs = {path.name: sha256(data)}
    sizes: dict[str, int] = {}
    mesh = parse_mesh(data, path, NotedFolder(inner.path, inner, inner.path, notes, sizes))
    return mesh, notes, _input_bytes(len(data), sizes)


def _input_bytes(file: int, beside: Mapping[str, int]) -> InputBytes:
    of_mesh = sum(size for way, size in beside.items() if way.lower().endswith(OF_THE_MESH))
    return InputBytes(file + of_mesh, sum(beside.values()) - of_mesh)


def unchanged(source: str, inputs: Mapping[str, str | None]) -> bool:
    """Whether every file that was read is still the same, and what was missing still is."""
    name = Path(source).name
    folder = storage_of(source).folder(source)
    if inputs.get(name) != _digest(source):
        return False
    return all(_same(folder, way, known) for way, known in inputs.items() if way != name)


def content(inputs: Mapping[str, str | None]) -> str:
    """SHA-256 of the hashes of all that an asset is read from."""
    return sha256(json.dumps(sorted(inputs.items())).encode())


def sha256(data: bytes) -> str:
    """In hexadecimal digits."""
    return hashlib.sha256(data).hexdigest()


def _same(folder: Folder, way: str, known: str | None) -> bool:
    found = folder.exact(way)
    if found is None or known is None:
        return found is None and known is None
    try:
        return sha256(folder.read(found)) == known
    except MeshError:
        return False


def _digest(source: str) -> str | None:
    try:
        return sha256(storage_of(source).read(source))
    except OSError:
        return None
