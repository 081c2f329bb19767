"""A metadata map with small integer keys, read field by field with its type checked."""

from __future__ import annotations

from typing import Any, TypeVar

from nispcodec.errors import FormatError

T = TypeVar("T")


class Record:
    """The map at `path` of a section. A field with its default is absent; unknown keys are errors.

    Every getter takes the key on disk, the field's name for the error, and the default.
    """

    def __init__(self, section: str, path: str, value: Any) -> None:
        if not isinstance(value, dict):
            raise FormatError(section, path, "a map", type(value).__name__)
        self.section = section
        self.path = path
        self._values = dict(value)

    def __contains__(self, key: int) -> bool:
        return key in self._values

    def take(self, key: int, name: str, kind: type[T], default: T | None = None) -> T:
        """The value of one field, removed from the record; without default it is required."""
        if key not in self._values:
            if default is None:
                raise self.error(name, "present", "absent")
            return default
        value = self._values.pop(key)
        if type(value) is not kind:
            raise self.error(name, kind.__name__, type(value).__name__)
        if value == default:
            raise self.error(name, "absent, being the default", value)
        return value

    def floats(
        self, key: int, name: str, count: int, default: tuple[float, ...] | None = None
    ) -> tuple[float, ...]:
        """An array of `count` floats."""
        fallback = None if default is None else list(default)
        values = self.take(key, name, list, fallback)
        if len(values) != count or not all(type(value) is float for value in values):
            raise self.error(name, f"{count} floats", values)
        return tuple(values)

    def member(self, key: int, name: str, members: tuple[str, ...], default: str) -> str:
        """A member of an enumeration, on disk its position counted from 1."""
        number = self.take(key, name, int, 1 + members.index(default))
        if not 1 <= number <= len(members):
            raise self.error(name, f"1 to {len(members)}", number)
        return members[number - 1]

    def finish(self) -> None:
        """Raises for keys that no getter asked for."""
        if self._values:
            raise self.error("keys", "only known keys", sorted(map(repr, self._values)))

    def error(self, name: str, expected: object, found: object) -> FormatError:
        """An error at this record."""
        return FormatError(self.section, f"{self.path}.{name}", expected, found)


def sparse(fields: dict[int, tuple[Any, Any]]) -> dict[int, Any]:
    """{key: (value, default)} without the fields that have their default."""
    return {key: value for key, (value, default) in fields.items() if value != default}
