"""A metadata map with small integer keys: written without its defaults, read field by field."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

from nispcodec.core.errors import FormatError

T = TypeVar("T")


class Record:
    """The map at `path` of a section. A field with its default is absent; unknown keys are errors.

    Every getter takes the key on disk, the field's name for the error, and the default; it removes
    the field from the record. Raises FormatError, naming the field, for a value that is no map, and
    in every getter for a field that is missing, malformed or has its default.
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
        """A field of one type, which must be that exactly; without default it is required."""
        if key not in self._values:
            if default is None:
                raise self.error(name, "present", "absent")
            return default
        value = self._values.pop(key)
        if type(value) is not kind:
            raise self.error(name, kind.__name__, type(value).__name__)
        if value == default:
            raise self.error(name, "absent, being the default", "present")
        return value

    def floats(
        self, key: int, name: str, count: int, default: tuple[float, ...] | None = None
    ) -> tuple[float, ...]:
        """An array of `count` floats."""
        fallback = None if default is None else list(default)
        values = self.take(key, name, list, fallback)
        if len(values) != count or not all(type(value) is float for value in values):
            raise self.error(name, f"{count} floats", f"{len(values)} values")
        return tuple(values)

    def integer(self, key: int, name: str, low: int, high: int, default: int | None = None) -> int:
        """An integer from `low` to `high`."""
        value = self.take(key, name, int, default)
        if not low <= value <= high:
            raise self.error(name, f"{low} to {high}", value)
        return value

    def member(self, key: int, name: str, members: tuple[str, ...]) -> str:
        """A member of an enumeration, on disk its position counted from 1; the first by default."""
        return members[self.integer(key, name, 1, len(members), 1) - 1]

    def text(self, key: int, name: str, default: str | None = None) -> str:
        """A text that `check_text` lets pass."""
        value = self.take(key, name, str, default)
        check_text(self.section, f"{self.path}.{name}", value)
        return value

    def finish(self) -> None:
        """Raises FormatError for keys that no getter asked for."""
        if self._values:
            raise self.error("keys", "only known keys", min(map(repr, self._values)))

    def error(self, name: str, expected: object, found: object) -> FormatError:
        """An error at field `name` of this record, to be raised by the caller."""
        return FormatError(self.section, f"{self.path}.{name}", expected, found)


def sparse(fields: dict[int, tuple[Any, Any]]) -> dict[int, Any]:
    """{key: (value, default)} -> {key: value} of the fields that do not have their default."""
    return {key: value for key, (value, default) in fields.items() if value != default}


def number(section: str, path: str, value: str, members: tuple[str, ...]) -> int:
    """A member's number on disk: its position in `members`, counted from 1.

    Raises FormatError at `path` of the section when it is no member.
    """
    if value not in members:
        raise FormatError(section, path, f"one of {', '.join(members)}", value)
    return 1 + members.index(value)


def check_text(section: str, path: str, value: str) -> None:
    """Raises FormatError at `path` of the section for a text with control characters.

    Names go into text formats (MTL) where a line break is a command.
    """
    if any(ord(letter) < 32 or ord(letter) == 127 for letter in value):
        raise FormatError(section, path, "text without control characters", repr(value))


def check_file_name(section: str, path: str, value: str) -> None:
    """Raises FormatError at `path` of the section for a text that is no bare file name.

    Whoever unpacks a file must not be led out of the folder.
    """
    check_text(section, path, value)
    if value in ("", ".", "..") or any(letter in value for letter in "/\\:"):
        raise FormatError(section, path, "a bare file name", repr(value))


@contextmanager
def located(section: str, path: str) -> Iterator[None]:
    """Raises errors of the types in `core`, which know no section, as FormatError with theirs.

    A field is named below `path`, or as it is where that is empty.
    """
    try:
        yield
    except FormatError as error:
        field = f"{path}.{error.field}" if path else error.field
        raise FormatError(section, field, error.expected, error.found) from error
