"""What is asked of a result, beside what was measured.

A command that has targets has a function `asked`, which gives those of a result file.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any, Literal

from benchmarks.measuring.result_file import Record

Verdict = Literal["met", "missed", "not measured"]


@dataclass(frozen=True)
class Target:
    """A number that is asked for: where it is in the record and what it may be."""

    name: str
    place: tuple[str, ...]
    limit: float
    at_least: bool = False

    def measured(self, record: Record) -> float:
        """The number in a record. Raises KeyError or TypeError where there is none."""
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
        verdict = "" if self.met(record) else "  MISSED"
        return f"{asset:<18}{self.name:<26}{self.asked:>14}{self.measured(record):>14.4g}{verdict}"

    @property
    def asked(self) -> str:
        """The limit in words."""
        return f"{'>=' if self.at_least else '<='} {self.limit:.4g}"


@dataclass(frozen=True)
class Asked:
    """A target and the record that it is asked of; `name` is the record's, as a rule an asset."""

    name: str
    target: Target
    record: Record

    @property
    def verdict(self) -> Verdict:
        """What came of it; "not measured" of what failed, or is older than the target."""
        try:
            return "met" if self.target.met(self.record) else "missed"
        except (KeyError, TypeError):
            return "not measured"

    def line(self) -> str:
        """Asked against measured."""
        if self.verdict == "not measured":
            return f"{self.name:<18}{self.target.name:<26}{self.target.asked:>14}  not measured"
        return self.target.line(self.name, self.record)


def asked_of_each(
    records: dict[str, Record], targets: Callable[[str], Iterable[Target]]
) -> Iterator[Asked]:
    """The targets of each record, by its name."""
    for name, record in records.items():
        yield from (Asked(name, target, record) for target in targets(name))
