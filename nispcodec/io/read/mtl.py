"""Wavefront MTL: the statements of a file, checked one by one but not yet understood."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import takewhile

from nispcodec.core.errors import MeshError
from nispcodec.io.read import wavefront

# Statements of numbers -> how many they may have. Each is a share, from 0 to 1.
_VALUES = {"kd": (1, 3), "ke": (1, 3), "d": (1,), "tr": (1,), "pr": (1,), "pm": (1,)}
# Statements of images; so are all that begin with map_.
_MAPS = ("norm", "bump", "disp", "decal", "refl")
# Statements that nearly every file has and a material here has no place for (docs/limits.md), and
# those that only shape what pc and aniso ask for.
_SILENT = frozenset(["ka", "ks", "ns", "ni", "illum", "sharpness", "pcr", "anisor"])
# Statements that are left out -> values with which they change nothing, as exporters write them.
_NEUTRAL = {"tf": (0.0, 1.0), "pc": (0.0,), "ps": (0.0,), "aniso": (0.0,)}
# Names that one warning lists.
_MOST_SHOWN = 8
_NUMBERS, _SWITCH, _WORD = "numbers", "on or off", "a word"
# Options of image statements -> the largest number of values they take, and what these are.
_OPTIONS = {
    "-blendu": (1, _SWITCH),
    "-blendv": (1, _SWITCH),
    "-bm": (1, _NUMBERS),
    "-boost": (1, _NUMBERS),
    "-cc": (1, _SWITCH),
    "-clamp": (1, _SWITCH),
    "-imfchan": (1, _WORD),
    "-mm": (2, _NUMBERS),
    "-o": (3, _NUMBERS),
    "-s": (3, _NUMBERS),
    "-t": (3, _NUMBERS),
    "-texres": (1, _NUMBERS),
    "-type": (1, _WORD),
}


@dataclass(frozen=True)
class MapStatement:
    """One image statement: options by name, the names that its file may have, its place."""

    references: tuple[str, ...]
    options: dict[str, list[str]]
    place: str = field(compare=False)

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

    Values and options that make no sense are left out, with new `warnings` that name the file
    `name`, the line, what was expected and what was found.
    """
    materials: dict[str, MtlMaterial] = {}
    left_out: dict[str, int] = {}
    current = MtlMaterial("")
    for number, line in wavefront.logical_lines(data):
        keyword = wavefront.text(line.split(None, 1)[0]).lower()
        place = f"{name}:{number}"
        if keyword == "newmtl":
            current = MtlMaterial(wavefront.rest(line))
            if current.name in materials:
                warnings.append(
                    f"{place}: material {current.name!r} is there twice: the last counts"
                )
            materials[current.name] = current
        elif keyword in _VALUES:
            try:
                current.values |= _values(keyword, line, place, warnings)
            except MeshError as why:
                warnings.append(f"{why}: {keyword} left out")
        elif keyword in _MAPS or keyword.startswith("map_"):
            statement = _map_statement(line, place, warnings)
            if any(statement.references):
                current.maps[keyword] = statement
            else:
                warnings.append(f"{place}: expected a file name, found nothing: {keyword} left out")
        elif not _is_no_loss(keyword, line):
            left_out.setdefault(keyword[:32], number)
    if left_out:
        warnings.append(_said(left_out, name))
    return materials


def _is_no_loss(keyword: str, line: bytes) -> bool:
    words, neutral = line.split()[1:], _NEUTRAL.get(keyword, ())
    numbers = [float(word) for word in words if is_number(wavefront.text(word))]
    unchanged = any(set(numbers) == {value} for value in neutral)
    return keyword in _SILENT or (unchanged and len(numbers) == len(words))


def _said(left_out: dict[str, int], name: str) -> str:
    names = list(map(repr, left_out))
    shown = ", ".join(names[:_MOST_SHOWN]) + (", ..." if names[_MOST_SHOWN:] else "")
    statements = "statement" if len(names) == 1 else "statements"
    first = next(iter(left_out.values()))
    return f"{name}: left out {statements} {shown}, first in line {first}"


def _values(keyword: str, line: bytes, place: str, warnings: list[str]) -> dict[str, list[float]]:
    words = [word for word in line.split()[1:] if word != b"-halo"]
    if words and words[0] in (b"spectral", b"xyz"):
        raise MeshError(f"{place}: expected a color in RGB, found {_shown(words)}")
    values = wavefront.numbers(words, 1, place)
    counts = _VALUES[keyword]
    if len(values) < counts[-1] and len(values) not in counts:
        raise MeshError(f"{place}: expected 1 or 3 numbers, found {_shown(words)}")
    values = values[: counts[-1]]
    if min(values) < 0 or max(values) > 1:
        warnings.append(f"{place}: expected numbers from 0 to 1, found {_shown(words)}: cut to it")
    return {keyword: values}


def _shown(words: Sequence[bytes]) -> str:
    return repr(wavefront.text(b" ".join(words[:8])))


def _map_statement(line: bytes, place: str, warnings: list[str]) -> MapStatement:
    """The statement, without options that make no sense: these may begin the image's name."""
    words = [wavefront.text(word) for word in line.split()]
    options: dict[str, list[str]] = {}
    names: tuple[str, ...] = ()
    at = 1
    while at < len(words) and words[at].startswith("-") and len(names) <= wavefront.MOST_SIGNS:
        option, after = words[at].lower(), words[at + 1 :]
        most, kind = _OPTIONS.get(option, (1, ""))
        values = _values_of_option(after[:most], kind)
        if kind and _are_sound(values, kind):
            options[option] = values
            at += 1 + len(values)
        elif kind or after:
            names += wavefront.names(line, at if not kind else at + 1)
            at += 1 + min(len(values), max(len(after) - 1, 0))
            found = repr(" ".join(values)) if kind else repr(option)
            wanted = f"{kind} after {option}" if kind else "an option of MTL"
            warnings.append(f"{place}: expected {wanted}, found {found}: left out")
        else:
            break
    return MapStatement((*names, *wavefront.names(line, at)), options, place)


def _values_of_option(words: Sequence[str], kind: str) -> list[str]:
    """The words that stand for an option's values, sound or not."""
    numbers = list(takewhile(_is_meant_as_number, words)) if kind == _NUMBERS else []
    return numbers or list(words[:1])


def _are_sound(values: Sequence[str], kind: str) -> bool:
    if kind == _NUMBERS:
        return bool(values) and all(map(is_number, values))
    return kind == _WORD or [value.lower() for value in values] in (["on"], ["off"])


def _is_meant_as_number(word: str) -> bool:
    return is_number(word) or wavefront.not_finite([word.encode()])


def is_number(word: str) -> bool:
    """Whether the word is a finite number."""
    try:
        return math.isfinite(float(word))
    except ValueError:
        return False
