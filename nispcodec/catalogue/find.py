"""Finding assets: folders, globs, single files, manifests, lists."""

from __future__ import annotations

import glob
import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path

from nispcodec.catalogue.manifest import SUFFIXES as MANIFESTS
from nispcodec.catalogue.manifest import read_manifest
from nispcodec.catalogue.plan import Asset, Problem
from nispcodec.catalogue.storage import is_remote
from nispcodec.core.errors import NispError
from nispcodec.io.load import READERS

MAGIC = "*?["
KNOWN = "a mesh file, a folder, a glob, a manifest (.csv, .jsonl) or -"


@dataclass(frozen=True)
class Patterns:
    """Which files of folders and globs are wanted, by their names or paths relative to them.

    include: all unless some are given; exclude: what is not wanted all the same.
    """

    include: tuple[str, ...] = ()
    exclude: tuple[str, ...] = ()

    def wanted(self, way: str) -> bool:
        """Whether a file is, by its path with slashes."""
        names = (way, way.rpartition("/")[2])

        def matches(patterns: tuple[str, ...]) -> bool:
            return any(fnmatch(name, pattern) for pattern in patterns for name in names)

        return (not self.include or matches(self.include)) and not matches(self.exclude)


def find_assets(
    inputs: Iterable[str], patterns: Patterns = Patterns(), listed: Iterable[str] = ()
) -> Iterator[Asset | Problem]:
    """The assets that the inputs mean, and a problem for each that means none.

    An input is a mesh file, a folder, a glob, a manifest, a URL of these through fsspec, or "-" for
    paths in `listed`, one a line. An output keeps its file's path relative to the folder, or to
    the part of a glob before the first wildcard.
    """
    for each in inputs:
        if each == "-":
            lines = (line.rstrip("\r\n") for line in listed)
            yield from find_assets((line for line in lines if line and line != "-"), patterns)
        else:
            yield from _of_one(each, patterns)


def _of_one(place: str, patterns: Patterns) -> Iterator[Asset | Problem]:
    path = Path(place)
    if "\0" in place:
        yield Problem(place, "expected a path without NUL, found one with it")
    elif path.suffix.lower() in MANIFESTS:
        yield from _of_manifest(place)
    elif is_remote(place):
        yield from _or_none(place, _of_url(place, patterns))
    elif path.is_dir():
        yield from _or_none(place, _of_folder(place, patterns))
    elif path.exists() or (path.suffix.lower() in READERS and not _is_glob(place)):
        yield _of_file(place)
    elif _is_glob(place):
        yield from _or_none(place, _of_glob(place, patterns))
    else:
        yield Problem(place, f"expected {KNOWN}, found none")


def _is_glob(place: str) -> bool:
    return any(each in place for each in MAGIC)


def _or_none(place: str, found: Iterator[Asset | Problem]) -> Iterator[Asset | Problem]:
    """What was found; a problem where nothing was."""
    empty = True
    for each in found:
        empty = False
        yield each
    if empty:
        yield Problem(place, f"expected mesh files ({' '.join(READERS)}), found none")


def _of_file(place: str) -> Asset | Problem:
    path = Path(place)
    if not path.is_file():
        return Problem(
            place, "expected a file, found " + ("none" if not path.exists() else "other")
        )
    if path.suffix.lower() not in READERS:
        return Problem(place, f"expected one of {' '.join(READERS)}, found {path.suffix!r}")
    return Asset(place, output_of(path.name), path.stat().st_size)


def _of_folder(top: str, patterns: Patterns) -> Iterator[Asset | Problem]:
    """All mesh files in a folder and below, links followed, in order of their paths."""
    problems: list[Problem] = []

    def unreadable(why: OSError) -> None:
        problems.append(
            Problem(str(why.filename), f"expected a folder to read, found: {why.strerror}")
        )

    for folder, below, names in os.walk(top, onerror=unreadable, followlinks=True):
        below[:] = sorted(name for name in below if not _leads_back(folder, name, problems))
        for name in sorted(names):
            place = os.path.join(folder, name)  # noqa: PTH118, as names need not be UTF-8
            way = os.path.relpath(place, top).replace(os.sep, "/")
            if Path(name).suffix.lower() in READERS and patterns.wanted(way):
                yield _sized(place, way)
    yield from problems


def _leads_back(folder: str, name: str, problems: list[Problem]) -> bool:
    """Whether a folder is a link to one that it is in; that is a problem."""
    place = Path(folder, name)
    if not place.is_symlink():
        return False
    loop = Path(folder).resolve().is_relative_to(place.resolve())
    if loop:
        problems.append(Problem(str(place), "expected a folder, found a link to one that it is in"))
    return loop


def _sized(place: str, way: str) -> Asset | Problem:
    try:
        return Asset(place, output_of(way), Path(place).stat().st_size)
    except OSError as why:
        return Problem(place, f"expected a file that can be read, found: {why.strerror}")


def _of_glob(pattern: str, patterns: Patterns) -> Iterator[Asset | Problem]:
    parts = Path(pattern).parts
    fixed = next(number for number, part in enumerate(parts) if _is_glob(part))
    top = str(Path(*parts[:fixed]))
    for place in sorted(glob.glob(pattern, recursive=True)):  # noqa: PTH207, as ** follows links
        way = os.path.relpath(place, top).replace(os.sep, "/")
        path = Path(place)
        if path.suffix.lower() in READERS and path.is_file() and patterns.wanted(way):
            yield _sized(place, way)


def _of_url(place: str, patterns: Patterns) -> Iterator[Asset | Problem]:
    from nispcodec.catalogue.remote import Remote

    top = _top(place).partition("://")[2].strip("/") + "/"
    try:
        for url, size in Remote(place).found(place):
            way = url.partition(top)[2]
            if Path(url).suffix.lower() in READERS and patterns.wanted(way):
                yield Asset(url, output_of(way), size)
    except (OSError, NispError) as why:
        yield Problem(place, str(why))


def _top(url: str) -> str:
    """The folder that outputs keep their paths from."""
    if _is_glob(url):
        return url[: min(url.find(each) for each in MAGIC if each in url)].rpartition("/")[0]
    return url.rpartition("/")[0] if Path(url).suffix.lower() in READERS else url


def _of_manifest(place: str) -> Iterator[Asset | Problem]:
    for each in read_manifest(place):
        if isinstance(each, Problem):
            yield each
            continue
        found = each if is_remote(each.source) else _of_file(each.source)
        if isinstance(found, Problem):
            yield found
        else:
            output = each.output or output_of(Path(each.source).name)
            yield Asset(each.source, output, found.size, each.options)


def output_of(way: str) -> str:
    """The path of the `.nisp` for a mesh file's path."""
    return way.removesuffix(Path(way).suffix) + ".nisp"
