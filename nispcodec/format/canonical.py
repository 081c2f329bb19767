"""Canonical msgpack: one value, one byte string. Strict both ways.

Maps are sorted by their encoded keys, integers and lengths take the fewest bytes, a float is
float32 when that loses nothing, there are no extensions and no NaN or infinity. A reader checks
all of it by writing what it read and comparing.
"""

from __future__ import annotations

import math
import struct
from typing import Any

import msgpack

from nispcodec.errors import FormatError
from nispcodec.format.constants import MAX_DEPTH, MAX_ITEMS, MAX_METADATA, MAX_TEXT


def encode(section: str, value: Any) -> bytes:
    """Value of dict, list, str, bytes, int, float and bool -> msgpack."""
    data = _encode(section, value, 1)
    if len(data) > MAX_METADATA:
        raise FormatError(section, "length", f"at most {MAX_METADATA} bytes", len(data))
    return data


def decode(section: str, data: bytes) -> Any:
    """Msgpack -> value; `FormatError` when it is malformed, too large or not canonical."""
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
        raise FormatError(section, "msgpack", "well-formed msgpack", repr(error)) from error
    if _encode(section, value, 1) != data:
        raise FormatError(section, "msgpack", "canonical form", "another form of the same value")
    return value


def _encode(section: str, value: Any, depth: int) -> bytes:
    if depth > MAX_DEPTH:
        raise FormatError(section, "depth", f"at most {MAX_DEPTH}", "deeper nesting")
    if isinstance(value, dict):
        pairs = [
            (_encode(section, key, depth + 1), _encode(section, item, depth + 1))
            for key, item in value.items()
        ]
        header = msgpack.Packer().pack_map_header(len(pairs))
        return bytes(header) + b"".join(key + item for key, item in sorted(pairs))
    if isinstance(value, (list, tuple)):
        header = msgpack.Packer().pack_array_header(len(value))
        return bytes(header) + b"".join(_encode(section, item, depth + 1) for item in value)
    if isinstance(value, float):
        return _encode_float(section, value)
    return _encode_scalar(section, value)


def _encode_float(section: str, value: float) -> bytes:
    if not math.isfinite(value):
        raise FormatError(section, "number", "a finite number", value)
    try:
        single = struct.pack(">f", value)
    except OverflowError:
        return b"\xcb" + struct.pack(">d", value)
    if struct.unpack(">f", single)[0] == value:
        return b"\xca" + single
    return b"\xcb" + struct.pack(">d", value)


def _encode_scalar(section: str, value: Any) -> bytes:
    if not isinstance(value, (bool, int, str, bytes)):
        raise FormatError(section, "type", "map, array, text, bytes, number or bool", type(value))
    if isinstance(value, str) and len(value.encode("utf-8", "replace")) > MAX_TEXT:
        raise FormatError(section, "text", f"at most {MAX_TEXT} bytes", len(value))
    try:
        return bytes(msgpack.packb(value))
    except (OverflowError, UnicodeEncodeError) as error:
        raise FormatError(section, "value", "64-bit integer or UTF-8 text", value) from error
