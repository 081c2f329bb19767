"""The tables of a PLY file, in text or binary, as the header lays them out."""

from __future__ import annotations

import math
import re
import struct
from collections.abc import Sequence
from dataclasses import dataclass, field

from nispcodec.core.counted import counted
from nispcodec.core.errors import MeshError
from nispcodec.io.read import wavefront

_TYPES = {
    "char": "b", "int8": "b", "uchar": "B", "uint8": "B", "short": "h", "int16": "h",
    "ushort": "H", "uint16": "H", "int": "i", "int32": "i", "uint": "I", "uint32": "I",
    "float": "f", "float32": "f", "double": "d", "float64": "d",
}  # fmt: skip
_ORDERS = {"binary_little_endian": "<", "binary_big_endian": ">"}
_KEYWORDS = {"ply", "format", "comment", "obj_info", "element", "property"}
# The line of its own, which a comment may quote.
_END = re.compile(rb"[\r\n]end_header[ \t]*(?:\r?\n|\r)")
# Comments before the name of an image, besides MeshLab's TextureFile.
_TEXTURE = re.compile(r"texture[_-]?(file|name|map)?[:=]?", re.IGNORECASE)


@dataclass(frozen=True)
class Property:
    """A column: its struct code, and that of its count when it is a list."""

    name: str
    code: str
    count_code: str = ""


@dataclass
class Element:
    """A table of the file; scalar columns are lists of numbers, list columns lists of lists."""

    name: str
    count: int
    properties: list[Property] = field(default_factory=list)
    columns: dict[str, list[float]] = field(default_factory=dict)
    lists: dict[str, list[Sequence[float]]] = field(default_factory=dict)


@dataclass
class Header:
    """A PLY header; `size` is its length in bytes.

    `textures` are the names of texture files, `likely_textures` what other comments seem to name,
    `unknown` the places of lines without a keyword: some exporters forget the word comment.
    """

    format: str
    elements: list[Element]
    textures: list[str]
    likely_textures: list[str]
    unknown: list[str]
    size: int


def parse_header(data: bytes, name: str) -> Header:
    """Parse the file up to and including the line `end_header`.

    Raises MeshError, naming the file `name` and the line, for a malformed header.
    """
    end = _END.search(data)
    if not data.startswith(b"ply") or end is None:
        raise MeshError(f"{name}: expected a header from 'ply' to 'end_header', found none")
    header = Header("", [], [], [], [], end.end())
    for number, line in enumerate(data[: end.start()].splitlines(), 1):
        words = wavefront.text(line).split()
        if words and words[0] not in _KEYWORDS:
            header.unknown.append(f"{name}:{number}")
            continue
        try:
            _header_line(header, words, line)
        except (ValueError, LookupError) as why:
            shown = wavefront.text(line[:60])
            raise MeshError(f"{name}:{number}: expected a PLY header, found {shown!r}") from why
    if header.format != "ascii" and header.format not in _ORDERS:
        raise MeshError(f"{name}: expected a PLY format, found {header.format!r}")
    _expect_different([element.name for element in header.elements], f"{name}: elements")
    for element in header.elements:
        names = [column.name for column in element.properties]
        _expect_different(names, f"{name}: properties of {element.name}")
    return header


def _expect_different(names: Sequence[str], place: str) -> None:
    repeated = [each for index, each in enumerate(names) if each in names[:index]]
    if repeated:
        raise MeshError(f"{place}: expected different names, found {repeated[0]!r} twice")


def _header_line(header: Header, words: list[str], line: bytes) -> None:
    match words:
        case ["format", found, "1.0"]:
            header.format = found
        case ["comment", "TextureFile", _, *_]:
            header.textures.append(wavefront.rest(line, 2))
        case ["comment", key, _, *_] if _TEXTURE.fullmatch(key):
            header.likely_textures.append(wavefront.rest(line, 2))
        case ["element", found, count]:
            if not 0 <= int(count) < 2**31:
                raise ValueError(count)
            header.elements.append(Element(found, int(count)))
        case ["property", "list", count, item, found]:
            header.elements[-1].properties.append(Property(found, _TYPES[item], _TYPES[count]))
        case ["property", item, found]:
            header.elements[-1].properties.append(Property(found, _TYPES[item]))
        case ["ply"] | ["comment", *_] | ["obj_info", *_] | []:
            pass
        case _:
            raise ValueError(words)


class _Text:
    """The body of a text file as a queue of numbers."""

    def __init__(self, body: bytes) -> None:
        self._words = body.split()
        self._at = 0

    @property
    def left(self) -> int:
        """No more numbers than this are there."""
        return len(self._words) - self._at

    def take(self, codes: str) -> Sequence[float]:
        words = self._words[self._at : self._at + len(codes)]
        self._at += len(codes)
        if len(words) < len(codes):
            raise ValueError("the end of the file")
        try:
            return [float(word) for word in words]
        except ValueError:
            return [_number(word) for word in words]


def _number(word: bytes) -> float:
    """NaN for what any C library writes for no finite number. Raises ValueError for other words."""
    return math.nan if wavefront.not_finite([word]) else float(word)


class _Binary:
    """The body of a binary file as a queue of numbers."""

    def __init__(self, body: bytes, order: str) -> None:
        self._body = body
        self._order = order
        self._at = 0

    @property
    def left(self) -> int:
        """No more numbers than this are there."""
        return len(self._body) - self._at

    def take(self, codes: str) -> Sequence[float]:
        layout = self._order + codes
        size = struct.calcsize(layout)
        if self._at + size > len(self._body):
            raise ValueError("the end of the file")
        values = struct.unpack_from(layout, self._body, self._at)
        self._at += size
        return values


def read_elements(header: Header, data: bytes, name: str) -> list[str]:
    """Fill the header's elements from the file that it is the head of -> warnings.

    Raises MeshError, naming the file `name` and the row, where the file holds something else.
    """
    body = data[header.size :]
    order = _ORDERS.get(header.format)
    queue = _Text(body) if order is None else _Binary(body, order)
    for element in header.elements:
        for row in range(element.count if element.properties else 0):
            try:
                _read_row(element, queue)
            except (ValueError, OverflowError) as why:
                raise MeshError(
                    f"{name}: {element.name} {row}: expected numbers as in the header, found: {why}"
                ) from why
    left = counted(queue.left, "number" if order is None else "byte")
    said = f"{name}: left out {left} after the last row of the header's elements"
    return [said] if queue.left > 0 else []


def _read_row(element: Element, queue: _Text | _Binary) -> None:
    take = queue.take
    if not any(column.count_code for column in element.properties):
        values = take("".join(column.code for column in element.properties))
        for column, value in zip(element.properties, values, strict=True):
            element.columns.setdefault(column.name, []).append(value)
        return
    for column in element.properties:
        if not column.count_code:
            element.columns.setdefault(column.name, []).append(take(column.code)[0])
            continue
        count = int(take(column.count_code)[0])
        if not 0 <= count <= queue.left:
            raise ValueError(f"a list of {count}")
        element.lists.setdefault(column.name, []).append(take(column.code * count))
