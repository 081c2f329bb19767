"""The `info` field of META: how a file was made and what was measured.

Keys and presets that the format knows are numbers on disk; others are text. Shares and errors are
counted in millionths where that is exact, other floats are float32: three digits are all that a
measurement is good for.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from nispcodec.core.errors import FormatError
from nispcodec.format.constants import MEASURES, META, PRESETS
from nispcodec.format.record import check_text

Scalar = str | int | float | bool
_PLAIN = "text, a number or a bool"
_PRESET, _SEED, _COUNTED = MEASURES[0], MEASURES[1], MEASURES[2:]
_KINDS: dict[str, tuple[tuple[type, ...], str]] = {
    _PRESET: ((str, int), "text, or a preset's number"),
    _SEED: ((int,), "an integer"),
    **dict.fromkeys(_COUNTED, ((int, float), "a number")),
}
_MILLION = 1_000_000
_MOST = 1000.0


def encode(info: Mapping[str, Scalar]) -> dict[int | str, Scalar]:
    """A document's `info` -> its map on disk.

    Raises FormatError for a value of another type than its key's, and a text with control
    characters.
    """
    for key, value in info.items():
        if not isinstance(key, str):
            raise _error(key, "text as key", type(key).__name__)
        check_text(META, "document.info", key)
        _check(key, value)
    return {
        1 + MEASURES.index(key) if key in MEASURES else key: _stored(key, value)
        for key, value in info.items()
    }


def decode(stored: dict[Any, Any]) -> dict[str, Scalar]:
    """The inverse of `encode`; a float32 comes back as the shortest decimal that means it.

    Raises FormatError for an unknown number, a text that has a number, a value of another type than
    its key's, and a text with control characters.
    """
    info: dict[str, Scalar] = {}
    for key, value in stored.items():
        name = _name(key)
        _check(name, value)
        counted = name in _COUNTED and type(value) is int
        if name == _PRESET:
            info[name] = _preset(value)
        else:
            info[name] = value / _MILLION if counted else _shortest(value)
    return info


def _name(key: object) -> str:
    if type(key) is int and 1 <= key <= len(MEASURES):
        return MEASURES[key - 1]
    if type(key) is not str or key in MEASURES:
        raise _error(key, f"1 to {len(MEASURES)}, or another name", repr(key))
    check_text(META, "document.info", key)
    return key


def _check(name: str, value: object) -> None:
    kinds, expected = _KINDS.get(name, ((str, int, float, bool), _PLAIN))
    if not isinstance(value, kinds) or (isinstance(value, bool) and bool not in kinds):
        raise _error(name, expected, type(value).__name__)
    if isinstance(value, str):
        check_text(META, f"document.info.{name}", value)


def _preset(value: Scalar) -> str:
    if type(value) is int and 1 <= value <= len(PRESETS):
        return PRESETS[value - 1]
    if not isinstance(value, str) or value in PRESETS:
        raise _error(_PRESET, f"1 to {len(PRESETS)}, or another name", repr(value))
    return value


def _stored(key: str, value: Scalar) -> Scalar:
    if key == _PRESET:
        if not isinstance(value, str):
            raise _error(key, "text", type(value).__name__)
        return 1 + PRESETS.index(value) if value in PRESETS else value
    if key in _COUNTED and not isinstance(value, str):
        count = round(value * _MILLION) if abs(value) < _MOST else 0
        return count if count / _MILLION == value else _single(float(value))
    return _single(value) if isinstance(value, float) else value


def _single(value: float) -> float:
    with np.errstate(over="ignore"):
        single = float(np.float32(value))
    return single if np.isfinite(single) else value


def _shortest(value: Scalar) -> Scalar:
    if not isinstance(value, float) or _single(value) != value:
        return value
    with np.errstate(over="ignore"):
        shortest = float(str(np.float32(value)))
    return shortest if np.isfinite(shortest) else value


def _error(key: object, expected: str, found: str) -> FormatError:
    return FormatError(META, f"document.info.{key}", expected, found)
