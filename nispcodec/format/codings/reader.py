"""A cursor over the bytes of a section that never reads past their end."""

from __future__ import annotations

from nispcodec.core.errors import FormatError


class Reader:
    """Reads `data` of `section` from front to back; `path` says where we are, for the errors.

    Every method takes the name of the field that it reads. Raises FormatError, naming section, path
    and field, for bytes that are missing or out of range.
    """

    def __init__(self, section: str, data: bytes | memoryview) -> None:
        self.section = section
        self.path = ""
        self.position = 0
        self._data = memoryview(data)

    def take(self, count: int, name: str) -> memoryview:
        """The next `count` bytes."""
        left = len(self._data) - self.position
        if count > left:
            raise self.error(name, f"{count} bytes", f"{left} bytes left")
        self.position += count
        return self._data[self.position - count : self.position]

    def rest(self) -> memoryview:
        """All bytes that are left; the position stays."""
        return self._data[self.position :]

    def member(self, name: str, members: tuple[str, ...], allowed: tuple[str, ...]) -> str:
        """One byte: a member of an enumeration, counted from 1, and of the `allowed` ones."""
        number = self.take(1, name)[0]
        member = members[number - 1] if 1 <= number <= len(members) else None
        if member is None or member not in allowed:
            raise self.error(name, f"one of {', '.join(allowed)}", number)
        return member

    def varint(self, name: str, maximum: int) -> int:
        """An unsigned integer up to `maximum` (below 2^35), LEB128 in its shortest form."""
        value = 0
        for shift in range(0, 35, 7):
            byte = self.take(1, name)[0]
            value |= (byte & 0x7F) << shift
            if byte < 0x80:
                if (byte == 0 and shift) or value > maximum:
                    raise self.error(name, f"at most {maximum}, in the fewest bytes", value)
                return value
        raise self.error(name, "an integer of at most 5 bytes", "more")

    def finish(self) -> None:
        """Raises FormatError when bytes are left."""
        if self.position != len(self._data):
            raise self.error("end", self.position, len(self._data))

    def error(self, name: str, expected: object, found: object) -> FormatError:
        """An error at the current place, to be raised by the caller."""
        return FormatError(self.section, f"{self.path}{name}", expected, found)


def varint(value: int) -> bytes:
    """A non-negative integer -> unsigned LEB128 (DWARF 5, 7.6) in its shortest form."""
    out = bytearray()
    while value >= 0x80:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)
