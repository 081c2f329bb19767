"""The grammar that OBJ and MTL files share: lines, comments, names, numbers."""

from __future__ import annotations

import codecs
import math
import re
from collections.abc import Iterator, Sequence
from itertools import islice

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
_WIDE_MARKS = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)


def logical_lines(data: bytes) -> Iterator[tuple[int, bytes]]:
    """(number, line) without comments and blank lines; a line ending in a backslash goes on.

    A line that was continued has the number of its first part. A statement that ends in a name
    keeps what follows "#": whether that is a comment only `names` can tell.
    """
    if data.startswith(_WIDE_MARKS):  # as PowerShell writes text
        data = data.decode("utf-16", errors="replace").encode()
    data = data.removeprefix(BYTE_ORDER_MARK).replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    parts: list[bytes] = []
    for number, raw in enumerate([*data.split(b"\n"), b""], 1):
        commented = b"#" in raw and not _NAMING.match(raw)
        line = (_COMMENT.sub(b"", raw) if commented else raw).strip()
        if line.endswith(b"\\"):
            parts.append(line[:-1])
            continue
        first = number - len(parts)
        if parts:
            line = b" ".join([*parts, line]).strip()
            parts = []
        if line:
            yield first, line


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
