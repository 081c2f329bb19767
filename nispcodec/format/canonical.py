"""Canonical msgpack: one value, one byte string. Strict both ways.

Maps are sorted by their encoded keys, integers and lengths take the fewest bytes, a float is
float32 when that loses nothing, there are no extensions, no nil, no NaN and no infinity. A reader
checks all of it by writing what it read and comparing.
"""

from __future__ import annotations

import math
import struct
from typing import Any

import msgpack

from nispcodec.core.errors import FormatError
from nispcodec.format.constants import (
    MAX_DEPTH,
    MAX_ITEMS,
    MAX_METADATA,
    MAX_TEXT,
    MAX_VALUES,
)


def encode(section: str, value: Any) -> bytes:
    """A value of dict, list, str, bytes, int, float and bool -> canonical msgpack.

    Raises FormatError, naming `section`, for a value of another type or beyond the caps.
    """
    data = _Encoder(section).encode(value, 1)
    if len(data) > MAX_METADATA:
        raise FormatError(section, "length", f"at most {MAX_METADATA} bytes", len(data))
    return data


def decode(section: str, data: bytes | memoryview) -> Any:
    """Canonical msgpack -> value.

    Raises FormatError, naming `section`, when it is malformed, beyond the caps or not canonical.
    """
    if len(data) > MAX_METADATA:
        raise FormatError(section, "length", f"at most {MAX_METADATA} bytes", len(data))
    try:
        value = msgpack.unpackb(
            data,
            strict_map_key=False,
            max_str_len=MAX_TEXT,
            max_bin_len=MAX_METADATA,
            max_array_len=MAX_ITEMS,
            max_map_len=MAX_ITEMS,
            max_ext_len=0,
        )
    except (ValueError, TypeError, msgpack.UnpackException) as error:
        reason = f"{type(error).__name__} {error}".strip()
        raise FormatError(section, "msgpack", "well-formed msgpack", reason) from error
    if _Encoder(section).encode(value, 1) != data:
        raise FormatError(section, "msgpack", "canonical form", "another form of the same value")
    return value


class _Encoder:
    """Writes values of one section, counting them against the cap."""

    def __init__(self, section: str) -> None:
        self._section = section
        self._count = 0

    def encode(self, value: Any, depth: int) -> bytes:
        self._count += 1
        self._limit("depth", depth, MAX_DEPTH)
        self._limit("values", self._count, MAX_VALUES)
        if isinstance(value, dict):
            return self._map(value, depth)
        if isinstance(value, (list, tuple)):
            self._limit("array_length", len(value), MAX_ITEMS)
            items = b"".join(self.encode(item, depth + 1) for item in value)
            return bytes(msgpack.Packer().pack_array_header(len(value))) + items
        if isinstance(value, float):
            return self._float(value)
        return self._scalar(value)

    def _map(self, value: dict[Any, Any], depth: int) -> bytes:
        self._limit("map_length", len(value), MAX_ITEMS)
        pairs = sorted(
            (self.encode(key, depth + 1), self.encode(item, depth + 1))
            for key, item in value.items()
        )
        header = bytes(msgpack.Packer().pack_map_header(len(pairs)))
        return header + b"".join(key + item for key, item in pairs)

    def _float(self, value: float) -> bytes:
        if not math.isfinite(value):
            raise FormatError(self._section, "number", "a finite number", value)
        try:
            single = struct.pack(">f", value)
        except OverflowError:
            return b"\xcb" + struct.pack(">d", value)
        if struct.unpack(">f", single)[0] == value:
            return b"\xca" + single
        return b"\xcb" + struct.pack(">d", value)

    def _scalar(self, value: Any) -> bytes:
        if not isinstance(value, (bool, int, str, bytes)):
            expected = "map, array, text, bytes, number or bool"
            raise FormatError(self._section, "type", expected, type(value).__name__)
        if isinstance(value, str):
            self._limit("text_length", len(value.encode(errors="replace")), MAX_TEXT)
        try:
            return bytes(msgpack.packb(value))
        except (OverflowError, UnicodeEncodeError) as error:
            expected = "a 64-bit integer or UTF-8 text"
            raise FormatError(self._section, "value", expected, repr(value)) from error

    def _limit(self, name: str, value: int, maximum: int) -> None:
        if value > maximum:
            raise FormatError(self._section, name, f"at most {maximum}", value)
