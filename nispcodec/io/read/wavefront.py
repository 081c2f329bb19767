"""The grammar that OBJ and MTL files share: lines, comments, names, numbers."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence

from nispcodec.core.errors import MeshError

_COMMENT = re.compile(rb"(?:^|\s)#.*")
_BYTE_ORDER_MARK = b"\xef\xbb\xbf"


def logical_lines(data: bytes) -> Iterator[tuple[int, bytes]]:
    """(number, line) without comments and blank lines; a line ending in a backslash goes on.

    A line that was continued has the number of its first part.
    """
    data = data.removeprefix(_BYTE_ORDER_MARK).replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    parts: list[bytes] = []
    for number, raw in enumerate([*data.split(b"\n"), b""], 1):
        line = (_COMMENT.sub(b"", raw) if b"#" in raw else raw).strip()
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
    words = line.split(None, skipped)
    name = text(words[skipped]).strip() if len(words) > skipped else ""
    quoted = len(name) > 1 and name[0] == name[-1] and name[0] in "\"'"
    return name[1:-1] if quoted else name


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
