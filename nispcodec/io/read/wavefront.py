"""The grammar that OBJ and MTL files share: lines, comments, names, numbers."""

from __future__ import annotations

import codecs
import math
import re
from collections.abc import Iterator, Sequence
from itertools import groupby, islice
from operator import itemgetter

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.core.errors import MeshError

_COMMENT = re.compile(rb"(?:^|\s)#.*")
# Statements that end in a name, of which "#" may be a part: KeyShot writes "usemtl Grey #1".
_NAMING = re.compile(
    rb"\s*(?:usemtl|mtllib|newmtl|map_\w+|norm|bump|disp|decal|refl)\s", re.IGNORECASE
)
# What C libraries write for what is no finite number, which Python reads in part.
_NOT_FINITE = re.compile(rb"[+-]?(?:nan(?:\(\w*\))?|inf(?:inity)?|1\.#\w+)", re.IGNORECASE)
# More "#" in a line than this belong to no name.
MOST_SIGNS = 8
BYTE_ORDER_MARK = b"\xef\xbb\xbf"
# A backslash with nothing after it, but for a comment: the line goes on in the next.
_GOES_ON = re.compile(rb"\\[^\S\n]*(?:#.*)?$", re.MULTILINE)
# Lines that begin alike are read at once from so many on.
SHORTEST_RUN = 16
# And so many at most: words take far more memory than their text.
LONGEST_RUN = 1 << 16
# Coordinates beyond this are no finite numbers when they are added.
_LARGEST = 1e300
WIDE_MARKS = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)


def logical_lines(data: bytes) -> Iterator[tuple[int, bytes]]:
    """(number, line) without comments and blank lines, of a format without continued lines.

    A statement that ends in a name keeps what follows "#": whether that is a comment only `names`
    can tell.
    """
    lines = map(_bare, _normal(data).split(b"\n"))
    return ((number, line) for number, line in enumerate(lines, 1) if line)


def runs(data: bytes) -> Iterator[tuple[int, bytes, list[bytes]]]:
    """All lines of a file in order, in parts that `joined` can read alone.

    Gives the number of a part's first line; the two bytes that all of its lines begin with, none
    where they do not begin alike, or are few; and the lines.
    """
    data = _normal(data)
    lines = data.split(b"\n")
    read = end = 0
    for beginning, alike in () if _GOES_ON.search(data) else groupby(lines, itemgetter(slice(2))):
        start, end = end, end + len(list(alike))
        if end - start < SHORTEST_RUN:
            continue
        if start > read:
            yield read + 1, b"", lines[read:start]
        for first in range(start, end, LONGEST_RUN):
            yield first + 1, beginning, lines[first : min(first + LONGEST_RUN, end)]
        read = end
    yield read + 1, b"", lines[read:]


def joined(lines: Sequence[bytes], number: int) -> Iterator[tuple[int, bytes]]:
    """As `logical_lines`, of lines of an OBJ file of which the first has a `number`.

    A line ending in a backslash goes on in the next, and has the number of its first part.
    """
    parts: list[bytes] = []
    for place, raw in enumerate([*lines, b""], number):
        line = _bare(raw)
        if line.endswith(b"\\"):
            parts.append(line[:-1])
            continue
        first = place - len(parts)
        if parts:
            line = b" ".join([*parts, line]).strip()
            parts = []
        if line:
            yield first, line


def _bare(raw: bytes) -> bytes:
    """The line without its comment and the spaces around it."""
    commented = b"#" in raw and not _NAMING.match(raw)
    return (_COMMENT.sub(b"", raw) if commented else raw).strip()


def table(lines: Sequence[bytes], keyword: bytes, least: int) -> Float64Array | None:
    """(lines, n) finite numbers after the `keyword` of each line, n at least `least`.

    None where the lines have any other form.
    """
    words = b" ".join(lines).split()
    width = len(lines[0].split())
    if len(words) != width * len(lines) or width <= least:
        return None
    if words[::width].count(keyword) != len(lines):
        return None
    del words[::width]
    try:
        values = np.fromiter(map(float, words), np.float64, len(words))
    except ValueError:
        return None
    return values.reshape(len(lines), -1) if np.abs(values).max() < _LARGEST else None


def _normal(data: bytes) -> bytes:
    """The text of a file with line feeds alone, without its mark."""
    if data.startswith(WIDE_MARKS):  # as PowerShell writes text
        data = data.decode("utf-16", errors="replace").encode()
    return data.removeprefix(BYTE_ORDER_MARK).replace(b"\r\n", b"\n").replace(b"\r", b"\n")


def text(raw: bytes) -> str:
    """The bytes of a name as text: UTF-8 if they are that, else Latin-1, which reads anything."""
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError:
        return raw.decode("latin-1")


def rest(line: bytes, skipped: int = 1) -> str:
    """The text after the first `skipped` words of a line, with its spaces, without its quotes."""
    return names(line, skipped)[0]


def names(line: bytes, skipped: int = 1) -> tuple[str, ...]:
    """The names that a line may hold after its first `skipped` words, the likeliest first.

    All the text with its spaces; then without what may be a comment, from each "#" on.
    """
    words = line.split(None, skipped)
    end = text(words[skipped]).strip() if len(words) > skipped else ""
    return tuple(_unquoted(name) for name in without_comments(end))


def without_comments(name: str) -> list[str]:
    """The name, then what is left of it before each "#" that follows a space, the last one first.

    Nothing is left of a name that is all comment. Only the first `MOST_SIGNS` count.
    """
    cuts = [match.start() for match in islice(re.finditer(r"(?:^|\s)#", name), MOST_SIGNS)]
    return [name, *(name[:cut].rstrip() for cut in reversed(cuts))]


def _unquoted(name: str) -> str:
    quoted = len(name) > 1 and name[0] == name[-1] and name[0] in "\"'"
    return name[1:-1] if quoted else name


def not_finite(words: Sequence[bytes]) -> bool:
    """Whether one of the words is NaN or infinity, as any C library writes it."""
    return any(_NOT_FINITE.fullmatch(word) for word in words)


def numbers(words: Sequence[bytes], least: int, place: str) -> list[float]:
    """The words as finite numbers.

    Raises MeshError, naming `place`, for other words and for fewer than `least`.
    """
    try:
        values = [float(word) for word in words]
    except ValueError:
        values = []
    if len(values) < least or not math.isfinite(sum(values)):
        found = text(b" ".join(words[:8])) or "nothing"
        raise MeshError(f"{place}: expected {least} or more finite numbers, found {found!r}")
    return values
