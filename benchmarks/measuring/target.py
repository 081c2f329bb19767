"""What an issue asks, beside what was measured."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from benchmarks.measuring.result_file import Record


@dataclass(frozen=True)
class Target:
    """A number that an issue asks for: where it is in the record and what it may be."""

    name: str
    place: tuple[str, ...]
    limit: float
    at_least: bool = False

    def measured(self, record: Record) -> float:
        """The number in an asset's record."""
        value: Any = record
        for key in self.place:
            value = value[key]
        return float(value)

    def met(self, record: Record) -> bool:
        """Whether the measured number keeps the limit."""
        value = self.measured(record)
        return value >= self.limit if self.at_least else value <= self.limit

    def line(self, asset: str, record: Record) -> str:
        """Asked against measured."""
        asked = f"{'>=' if self.at_least else '<='} {self.limit:.4g}"
        verdict = "" if self.met(record) else "  MISSED"
        return f"{asset:<18}{self.name:<26}{asked:>14}{self.measured(record):>14.4g}{verdict}"
