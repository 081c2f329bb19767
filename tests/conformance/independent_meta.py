"""META read from `format_spec.md` alone: canonical MessagePack, and fields by its tables.

Everything that section 3, 4 and 9 forbid is an AssertionError.
"""

from __future__ import annotations

import math
import struct
from typing import Any

from tests.format import spec

CAPS = {row[0].strip("`"): int(row[1]) for row in spec.table_after("## 9 Caps")}
FRAME_OF_NETWORKS = "networks.sdf`, `networks.chart` and `networks.uv"
SIGNED = {0xD0: 1, 0xD1: 2, 0xD2: 4, 0xD3: 8}
UNSIGNED = {0xCC: 1, 0xCD: 2, 0xCE: 4, 0xCF: 8}
LENGTHS = {
    "str": {0xD9: 1, 0xDA: 2, 0xDB: 4},
    "bin": {0xC4: 1, 0xC5: 2, 0xC6: 4},
    "array": {0xDC: 2, 0xDD: 4},
    "map": {0xDE: 2, 0xDF: 4},
}
OF_FIELDS = ("charts", "chart_materials", "chart_has_uv", "uv_map", "half_thickness", "openings")
FIX = {"map": (0x80, 15), "array": (0x90, 15), "str": (0xA0, 31)}


class MessagePack:
    """One canonical value, and nothing after it."""

    def __init__(self, data: bytes) -> None:
        assert len(data) <= CAPS["MAX_METADATA"]
        self.data, self.at, self.values = data, 0, 0

    def whole(self) -> Any:
        """The value."""
        value = self.value(1)
        assert self.at == len(self.data)
        return value

    def take(self, count: int) -> bytes:
        """The next bytes."""
        assert self.at + count <= len(self.data)
        self.at += count
        return self.data[self.at - count : self.at]

    def value(self, depth: int) -> Any:
        """One value and its members."""
        self.values += 1
        assert depth <= CAPS["MAX_DEPTH"]
        assert self.values <= CAPS["MAX_VALUES"]
        first = self.take(1)[0]
        if first < 0x80 or first >= 0xE0:
            return first if first < 0x80 else first - 256
        if first in (0xC2, 0xC3):
            return first == 0xC3
        if first in SIGNED or first in UNSIGNED:
            return self.integer(first)
        if first in (0xCA, 0xCB):
            return self.float(first)
        kind, length = self.length(first)
        return getattr(self, kind)(length, depth)

    def integer(self, first: int) -> int:
        """An integer beyond the fix forms, in the fewest bytes."""
        if first in UNSIGNED:
            size = UNSIGNED[first]
            number = int.from_bytes(self.take(size), "big")
            assert number >= (128 if size == 1 else 256 ** (size // 2))
            return number
        size = SIGNED[first]
        number = int.from_bytes(self.take(size), "big", signed=True)
        assert number < (-32 if size == 1 else -(256 ** (size // 2)) // 2)
        return number

    def float(self, first: int) -> float:
        """A finite float, of four bytes where they hold it."""
        form = ">f" if first == 0xCA else ">d"
        number: float = struct.unpack(form, self.take(struct.calcsize(form)))[0]
        assert math.isfinite(number)
        assert first == 0xCA or not is_single(number)
        return number

    def length(self, first: int) -> tuple[str, int]:
        """Kind and length of a str, bin, array or map, in the fewest bytes."""
        for kind, (start, most) in FIX.items():
            if start <= first <= start + most:
                return kind, first - start
        for kind, sizes in LENGTHS.items():
            if first in sizes:
                size = sizes[first]
                length = int.from_bytes(self.take(size), "big")
                shorter = [256**other - 1 for other in sizes.values() if other < size]
                assert length > max([FIX.get(kind, (0, -1))[1], *shorter])
                return kind, length
        raise AssertionError("a type that is not allowed")

    def str(self, length: int, _: int) -> str:
        """UTF-8."""
        assert length <= CAPS["MAX_TEXT"]
        return self.take(length).decode("utf-8")

    def bin(self, length: int, _: int) -> bytes:
        """Bytes."""
        return self.take(length)

    def array(self, length: int, depth: int) -> list[Any]:
        """Members."""
        assert length <= CAPS["MAX_ITEMS"]
        return [self.value(depth + 1) for _ in range(length)]

    def map(self, length: int, depth: int) -> dict[Any, Any]:
        """Pairs, sorted by the bytes of their keys."""
        assert length <= CAPS["MAX_ITEMS"]
        pairs, before = {}, b""
        for _ in range(length):
            start = self.at
            key = self.value(depth + 1)
            encoded = self.data[start : self.at]
            assert encoded > before
            assert key not in pairs
            before = encoded
            pairs[key] = self.value(depth + 1)
        return pairs


def is_single(number: float) -> bool:
    """Whether a float32 holds it."""
    try:
        return bool(struct.unpack(">f", struct.pack(">f", number))[0] == number)
    except OverflowError:
        return False


def read_document(data: bytes) -> dict[str, Any]:
    """META's fields by name, defaults filled in, everything checked that META alone shows."""
    fields = named("document", MessagePack(data).whole())
    fields["networks"] = read_networks(fields)
    fields["materials"] = [read_material(value) for value in fields["materials"]]
    fields["textures"] = read_textures(fields["textures"])
    fields["info"] = {read_key(key): value for key, value in fields["info"].items()}
    fields["info"] = {name: read_measure(name, value) for name, value in fields["info"].items()}
    check_document(fields)
    return fields


def read_networks(fields: dict[str, Any]) -> dict[str, Any]:
    """The networks by name; without them nothing else is said about a field."""
    if fields["networks"] is None:
        usual = defaults("document")
        assert all(fields[name] == usual[name] for name in OF_FIELDS)
        return {}
    names = dict(enumerate(spec.enumeration("NETWORKS"), 1))
    assert fields["networks"].keys() <= names.keys()
    assert 1 in fields["networks"]
    return {
        names[number]: check_network(names[number], named(FRAME_OF_NETWORKS, value))
        for number, value in fields["networks"].items()
    }


def named(table: str, value: Any) -> dict[str, Any]:
    """A map's fields by name, by one of the tables of fields."""
    assert type(value) is dict
    left, found = dict(value), {}
    for key, name, kind, default, _ in spec.table_after(f"Fields of `{table}`"):
        if int(key) in left:
            found[name] = typed(kind, left.pop(int(key)))
            assert default == "" or found[name] != parsed(kind, default)
        else:
            assert default != "" or name == "length"
            found[name] = parsed(kind, default)
    assert not left
    assert all(type(key) is int for key in value)
    return found


def defaults(table: str) -> dict[str, Any]:
    """The default of every field of a table, None for a field without."""
    rows = spec.table_after(f"Fields of `{table}`")
    return {name: parsed(kind, default) for _, name, kind, default, _ in rows}


DEFAULTS: dict[str, Any] = {
    "all 0": None,
    "all set": None,
    "one map, empty": [{}],
    "empty": {},
    "false": False,
    "": None,
}


def parsed(kind: str, default: str) -> Any:
    """A default, from the word in the table."""
    if default in DEFAULTS or (kind, default) == ("map", "none"):
        return DEFAULTS.get(default)
    if kind.startswith("[float"):
        return [float(number) for number in default.split(",")]
    if kind == "float":
        return float(default)
    return int(default) if kind == "integer" else default


def typed(kind: str, value: Any) -> Any:
    """A value of the type that the table says; numbers of enumerations become names."""
    if kind.startswith("`"):
        members = spec.enumeration(kind.strip("`"))
        assert type(value) is int
        assert 1 <= value <= len(members)
        return members[value - 1]
    if kind.startswith("[float"):
        assert type(value) is list
        assert len(value) == int(kind[-2])
        assert all(type(number) is float for number in value)
        return value
    if kind == "array of integers":
        assert type(value) is list
        assert all(type(number) is int for number in value)
        return value
    python = {
        "integer": int,
        "float": float,
        "bool": bool,
        "bin": bytes,
        "map": dict,
        "array": list,
    }
    if kind == "text":
        return checked_text(value)
    assert type(value) is python[kind]
    return value


def checked_text(value: Any) -> str:
    """A text without control characters."""
    assert type(value) is str
    assert not any(ord(letter) < 32 or ord(letter) == 127 for letter in value)
    return value


def check_network(name: str, fields: dict[str, Any]) -> dict[str, Any]:
    """The ranges that section 4 gives in words."""
    assert 1 <= len(fields["hidden"]) <= CAPS["MAX_HIDDEN_LAYERS"]
    assert all(1 <= width <= CAPS["MAX_WIDTH"] for width in fields["hidden"])
    fourier = fields["encoding"] == "fourier"
    assert 1 <= fields["levels"] <= 16 if fourier else fields["levels"] == 0
    assert name == "uv" or fields["conditioning"] == "none"
    affine = fields["conditioning"] == "chart_affine"
    assert 1 <= fields["embedding"] <= 64 if affine else fields["embedding"] == 0
    assert 0 < fields["w0"] <= 1000
    assert 0 <= fields["mirror"] <= 63
    assert all(
        fields["mirror"] >> bit & 1 or not fields["mirror"] >> bit + 3 & 1 for bit in range(3)
    )
    assert 0 <= fields["init_seed"] <= CAPS["MAX_INIT_SEED"]
    return fields


def read_material(value: Any) -> dict[str, Any]:
    """A material, its maps by slot."""
    fields = named("materials", value)
    slots = dict(enumerate(spec.enumeration("SLOTS"), 1))
    assert all(type(number) is int for number in fields["maps"])
    fields["maps"] = {
        slots[number]: named("materials.maps.slot", used)
        for number, used in fields["maps"].items()
        if number in slots or refuse()
    }
    return fields


def refuse() -> bool:
    """For a number that a table does not have."""
    raise AssertionError("an unknown number")


def read_textures(values: list[Any]) -> list[dict[str, Any]]:
    """Textures, their names in full; the length of the last is None."""
    endings = {row[1]: row[2] for row in spec.table_after("Enumeration `MIME_TYPES`")}
    textures = [named("textures", value) for value in values]
    for number, texture in enumerate(textures):
        assert (texture["length"] is None) == (number == len(textures) - 1)
        name, ending = texture["name"], endings[texture["mime"]]
        assert name not in ("", ".", "..")
        assert not set(name) & set("/\\:")
        if "." not in name:
            texture["name"] = name + ending
        else:
            stem = name.removesuffix(ending)
            assert stem == name or stem == "" or "." in stem
    return textures


def read_key(key: Any) -> str:
    """The name of a measure."""
    names = spec.enumeration("MEASURES")
    if type(key) is int:
        assert 1 <= key <= len(names)
        return names[key - 1]
    assert key not in names
    return checked_text(key)


def read_measure(name: str, value: Any) -> Any:
    """The value of a measure."""
    assert type(value) in (str, int, float, bool)
    if type(value) is str:
        checked_text(value)
    if name == "preset":
        presets = spec.enumeration("PRESETS")
        if type(value) is int:
            assert 1 <= value <= len(presets)
            return presets[value - 1]
        assert type(value) is str
        assert value not in presets
    elif name == "seed":
        assert type(value) is int
    elif name in spec.enumeration("MEASURES"):
        assert type(value) in (int, float)
        return value / 1e6 if type(value) is int else value
    return value


def check_document(fields: dict[str, Any]) -> None:
    """What fields say of each other; chart tables become lists."""
    k, count = fields["charts"], len(fields["materials"])
    assert fields["frame"][3] > 0
    assert count >= 1
    for material in fields["materials"]:
        for used in material["maps"].values():
            assert 0 <= used["texture"] < len(fields["textures"])
    if fields["networks"]:
        check_field(fields, k, count)
    else:
        fields["chart_materials"], fields["chart_has_uv"] = [], []


def check_field(fields: dict[str, Any], k: int, count: int) -> None:
    """What fields say of networks and their charts."""
    assert 1 <= k <= CAPS["MAX_CHARTS"]
    fields["chart_materials"] = chart_materials(fields["chart_materials"], k, count)
    fields["chart_has_uv"] = chart_flags(fields["chart_has_uv"], k)
    assert ("chart" in fields["networks"]) == (k >= 2)
    assert ("uv" in fields["networks"]) == any(fields["chart_has_uv"])
    assert not fields["openings"] or (k >= 2 and not fields["chart_has_uv"][-1])


def chart_materials(data: bytes | None, k: int, count: int) -> list[int]:
    """The material of each chart."""
    if data is None:
        return [0] * k
    size = 1 if count <= 256 else 2
    assert len(data) == k * size
    numbers = [int.from_bytes(data[at : at + size], "little") for at in range(0, k * size, size)]
    assert any(numbers)
    assert max(numbers) < count
    return numbers


def chart_flags(data: bytes | None, k: int) -> list[bool]:
    """Which charts have texture coordinates."""
    if data is None:
        return [True] * k
    assert len(data) == (k + 7) // 8
    bits = [bool(byte & 0x80 >> place) for byte in data for place in range(8)]
    assert not any(bits[k:])
    assert not all(bits[:k])
    return bits[:k]
