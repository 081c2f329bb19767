"""Checked access to a glTF document's JSON: every surprise becomes an error with its place."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NoReturn

from nispcodec.core.errors import MeshError

# Instances and compression multiply what a small file holds: no more vertices or faces than this.
LARGEST = 20_000_000


def parse_json(data: bytes, name: str) -> Element:
    """The root object of a JSON text. Raises MeshError, naming the file `name`, for other text."""
    try:
        value = json.loads(data)
    except (ValueError, RecursionError) as why:
        raise MeshError(f"{name}: expected a glTF document in JSON, found: {why}") from why
    root = Element(value, name, "")
    if not isinstance(value, dict):
        root.fail("a JSON object", value)
    return root


@dataclass(frozen=True)
class Element:
    """A JSON value, its file, and its path in there, such as "meshes[0].primitives[1]".

    Raises MeshError, naming file and path, in every method that finds something else than it says.
    """

    value: object
    file: str
    path: str

    @property
    def place(self) -> str:
        """File and path, for messages."""
        return f"{self.file}: {self.path}" if self.path else self.file

    def fail(self, expected: str, found: object) -> NoReturn:
        """Raise MeshError for this place."""
        shown = repr(found)
        raise MeshError(f"{self.place}: expected {expected}, found {shown[:60]}")

    def get(self, key: str) -> Element | None:
        """The member `key` of an object, None when missing."""
        if not isinstance(self.value, dict):
            self.fail("an object", self.value)
        if key not in self.value:
            return None
        return Element(self.value[key], self.file, f"{self.path}.{key}" if self.path else key)

    def need(self, key: str) -> Element:
        """The member `key` of an object, which must be there."""
        member = self.get(key)
        return self.fail(f"a member {key!r}", "none") if member is None else member

    def entry(self, key: str, index: int) -> Element:
        """Item `index` of the array `key`, which must be there."""
        array = self.need(key)
        items = array._list()
        if not 0 <= index < len(items):
            array.fail(f"an index below {len(items)}", index)
        return Element(items[index], self.file, f"{array.path}[{index}]")

    def entries(self, key: str) -> list[Element]:
        """All items of the array `key`; an empty list when it is missing."""
        array = self.get(key)
        count = 0 if array is None else len(array._list())
        return [self.entry(key, index) for index in range(count)]

    def integer(self, key: str, default: int | None = None) -> int:
        """The non-negative integer `key`, below 2^53; required unless there is a default."""
        member = self.get(key)
        if member is None and default is not None:
            return default
        member = member or self.need(key)
        value = member.value
        if isinstance(value, float) and value.is_integer():
            value = int(value)
        if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value < 2**53:
            member.fail("a non-negative integer", member.value)
        return value

    def optional(self, key: str) -> int | None:
        """The non-negative integer `key`, None when missing."""
        return None if self.get(key) is None else self.integer(key)

    def number(self, key: str, default: float) -> float:
        """The finite number `key`."""
        member = self.get(key)
        return default if member is None else member._number()

    def numbers(self, key: str, default: Sequence[float]) -> tuple[float, ...]:
        """The array `key` of as many finite numbers as the default has."""
        member = self.get(key)
        if member is None:
            return tuple(default)
        values = self.numbers_of_any_count(key)
        if len(values) != len(default):
            member.fail(f"{len(default)} numbers", member.value)
        return values

    def numbers_of_any_count(self, key: str) -> tuple[float, ...]:
        """The array `key` of finite numbers, empty when it is missing."""
        member = self.get(key)
        items = [] if member is None else member._list()
        path = self.path if member is None else member.path
        return tuple(Element(item, self.file, path)._number() for item in items)

    def text(self, key: str, default: str) -> str:
        """The string `key`."""
        member = self.get(key)
        if member is None:
            return default
        return (
            member.value if isinstance(member.value, str) else member.fail("a string", member.value)
        )

    def flag(self, key: str) -> bool:
        """The boolean `key`, False when missing."""
        member = self.get(key)
        if member is None:
            return False
        return (
            member.value
            if isinstance(member.value, bool)
            else member.fail("a boolean", member.value)
        )

    def texts(self, key: str) -> list[str]:
        """The array of strings `key`, empty when missing."""
        member = self.get(key)
        items = [] if member is None else member._list()
        return [item if isinstance(item, str) else self.fail("strings", item) for item in items]

    def extension(self, name: str) -> Element | None:
        """The object of the glTF extension `name`, None when missing."""
        extensions = self.get("extensions")
        return None if extensions is None else extensions.get(name)

    def _list(self) -> list[object]:
        return self.value if isinstance(self.value, list) else self.fail("an array", self.value)

    def _number(self) -> float:
        value = self.value
        if isinstance(value, bool) or not isinstance(value, int | float):
            self.fail("a number", value)
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
        return number if math.isfinite(number) else self.fail("a finite number", value)
