"""Wavefront MTL: the statements of a file, not yet understood."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import takewhile

from nispcodec.core.errors import MeshError
from nispcodec.io.read import wavefront

_VALUES = ("kd", "ke", "d", "tr", "pr", "pm")
# Statements of images; so are all that begin with map_.
_MAPS = ("norm", "bump", "disp", "decal", "refl")
# Options of image statements -> the largest number of values they take.
_OPTIONS = {
    "-blendu": 1,
    "-blendv": 1,
    "-bm": 1,
    "-boost": 1,
    "-cc": 1,
    "-clamp": 1,
    "-imfchan": 1,
    "-mm": 2,
    "-o": 3,
    "-s": 3,
    "-t": 3,
    "-texres": 1,
    "-type": 1,
}


@dataclass(frozen=True)
class MapStatement:
    """One image statement: options by name, the names that its file may have, its place."""

    references: tuple[str, ...]
    options: dict[str, list[str]]
    place: str

    @property
    def reference(self) -> str:
        """The file's name for messages, without what is likely a comment."""
        return self.references[-1] or self.references[0]


@dataclass
class MtlMaterial:
    """One material as its statements stand in the file, keywords in lower case."""

    name: str
    values: dict[str, list[float]] = field(default_factory=dict)
    maps: dict[str, MapStatement] = field(default_factory=dict)


def parse_mtl(data: bytes, name: str, warnings: list[str]) -> dict[str, MtlMaterial]:
    """The materials of an MTL file by name.

    Values that are no finite numbers are left out, with new `warnings` that name the file `name`
    and the line.
    """
    materials: dict[str, MtlMaterial] = {}
    current = MtlMaterial("")
    for number, line in wavefront.logical_lines(data):
        keyword = wavefront.text(line.split(None, 1)[0]).lower()
        place = f"{name}:{number}"
        if keyword == "newmtl":
            current = MtlMaterial(wavefront.rest(line))
            materials[current.name] = current
        elif keyword in _VALUES:
            try:
                current.values |= _values(keyword, line, place)
            except MeshError as why:
                warnings.append(f"{why}: {keyword} left out")
        elif keyword in _MAPS or keyword.startswith("map_"):
            current.maps[keyword] = _map_statement(line, place)
    return materials


def _values(keyword: str, line: bytes, place: str) -> dict[str, list[float]]:
    words = [word for word in line.split()[1:] if word != b"-halo"]
    if words and words[0] in (b"spectral", b"xyz"):
        return {}
    return {keyword: wavefront.numbers(words, 1, place)}


def _map_statement(line: bytes, place: str) -> MapStatement:
    words = [wavefront.text(word) for word in line.split()]
    options: dict[str, list[str]] = {}
    at = 1
    while at < len(words) and words[at].lower() in _OPTIONS:
        option = words[at].lower()
        options[option] = _option_values(words[at + 1 : at + 1 + _OPTIONS[option]])
        at += 1 + len(options[option])
    return MapStatement(wavefront.names(line, at), options, place)


def _option_values(words: Sequence[str]) -> list[str]:
    """One value of any kind, then numbers: an option may have fewer than it could."""
    return [*words[:1], *takewhile(is_number, words[1:])]


def is_number(word: str) -> bool:
    """Whether the word is a finite number."""
    try:
        return math.isfinite(float(word))
    except ValueError:
        return False
