"""Every error this package raises on purpose; all derive from `NispError`."""

from __future__ import annotations


class NispError(Exception):
    """Base of all errors that a user can cause and fix."""


class NispWarning(UserWarning):
    """Something about an asset or its fit that its owner should know."""


class MeshError(NispError):
    """An input asset cannot be read or makes no sense.

    The text names the file, the place in it (line or element), what was expected and what was
    found.
    """


class FitError(NispError):
    """The networks could not be fitted to the asset, or not to the size or error asked for."""


class TargetSizeError(NispError):
    """A size that was asked for is too small: `least` bytes can be written, `found` were asked."""

    def __init__(self, least: int, found: float) -> None:
        super().__init__(
            f"target size: expected at least {least:,} bytes for this asset, found {found:,.0f}"
        )
        self.least = least
        self.found = found

    def __reduce__(self) -> tuple[object, ...]:
        # An exception is made anew from its text, when it comes from another process.
        return type(self), (self.least, self.found)


class QueryError(NispError):
    """A query makes no sense: shape, dtype or frame of points, a chart, a view, a channel."""


class FormatError(NispError):
    """A `.nisp` container is malformed.

    Attributes: `section` (four-character code or "header"), `field`, `expected`, `found`; `file`,
    where the bytes came from one.
    """

    file: str | None = None

    def __init__(self, section: str, field: str, expected: object, found: object) -> None:
        super().__init__(f"section {section}, field {field}: expected {expected}, found {found}")
        self.section = section
        self.field = field
        self.expected = expected
        self.found = found

    def __reduce__(self) -> tuple[object, ...]:
        # An exception is made anew from its text, when it comes from another process.
        return type(self), (self.section, self.field, self.expected, self.found), self.__dict__

    def __str__(self) -> str:
        text = super().__str__()
        return f"{self.file}: {text}" if self.file else text
