"""How old every committed result is, and which targets it misses: what to measure again, or mend.

    python -m benchmarks.status [--markdown]

The age is counted in commits that touch what the result follows, by the table in
`benchmarks.report.committed`; a result of several commits is as old as the oldest. Last come the
numbers that were asked for and that no result has. It measures nothing and ends with 0 whatever it
finds.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from importlib import import_module

import click

from benchmarks.measuring.build import HERE
from benchmarks.measuring.history import commits_since, committed, date_of
from benchmarks.measuring.result_file import Record, commits_of, read_result
from benchmarks.measuring.target import Asked
from benchmarks.report.committed import RESULTS, CommittedResult
from benchmarks.report.markdown import columns, table
from benchmarks.report.unmeasured import UNMEASURED

Shown = Callable[[Sequence[str], Sequence[Sequence[str]]], str]
"""A head and rows as text."""

FOLDER = "benchmarks/results"
AGES = ("result", "age, commits", "measured at", "by python -m")
MISSED = ("result", "of", "target", "asked", "measured")
WANTED = ("asked for, measured by no command", "asked")


@dataclass(frozen=True)
class Age:
    """A commit at which something was measured, and how many since touch it; None: not known."""

    commit: str
    commits: int | None

    def __str__(self) -> str:
        return f"{self.commit} ({date_of(HERE, self.commit) or 'not in the history'})"


def ages(result: CommittedResult) -> list[Age]:
    """Of all commits that a result was measured at, or what it was made from, the oldest last."""
    found = {age for each in RESULTS if each.file in result.made_from for age in ages(each)}
    if result.depends:
        commits = set(commits_of(read_result(HERE / FOLDER / result.file)))
        found |= {Age(each, commits_since(HERE, each, result.depends)) for each in commits}
    return sorted(found, key=lambda age: (age.commits is None, age.commits, age.commit))


def age_row(result: CommittedResult) -> list[str]:
    """A result's line in the table of ages: its oldest commit, and the newest where they differ."""
    every = ages(result)
    known = [age for age in every if age.commits is not None]
    unknown = [age for age in every if age.commits is None]
    ends = [*known[-1:], *known[:1]] if len(known) > 1 else known
    words = [str(age.commits) for age in reversed(ends)] or ["?"]
    where = ", ".join(map(str, [*ends, *unknown]))
    return [result.file, " to ".join(dict.fromkeys(words)), where, result.command]


def unmet(result: CommittedResult) -> Iterator[list[str]]:
    """Lines about the targets that a result misses or does not measure."""
    try:
        asked = list(_asked(result.module)(read_result(HERE / FOLDER / result.file)))
    except (ImportError, KeyError) as why:
        yield [result.file, "", f"not read: {type(why).__name__}: {why}", "", ""]
        return
    yield from (_missed(result.file, each) for each in asked if each.verdict != "met")


def _asked(module: str) -> Callable[[Record], Iterator[Asked]]:
    """The module's `asked`; of one that has no targets, nothing."""
    asked: Callable[[Record], Iterator[Asked]]
    asked = getattr(import_module(module), "asked", lambda results: iter(()))
    return asked


def _missed(file: str, asked: Asked) -> list[str]:
    missed = asked.verdict == "missed"
    found = f"{asked.target.measured(asked.record):.4g}" if missed else "not measured"
    return [file, asked.name, asked.target.name, asked.target.asked, found]


def lines(
    there: Sequence[str], show: Callable[[Sequence[str], Sequence[Sequence[str]]], str]
) -> str:
    """All tables: ages and targets of the results whose files are there, and what no result has."""
    present = [result for result in RESULTS if result.file in there]
    absent = [result.command for result in RESULTS if result.file not in there]
    strangers = set(there) - {name for each in RESULTS for name in (each.file, *each.beside)}
    missed = [line for result in present for line in unmet(result)]
    parts = [show(AGES, [age_row(result) for result in present])]
    parts.append(show(MISSED, missed) if missed else "No target is missed.\n")
    parts.append(show(WANTED, UNMEASURED))
    parts += [f"Not measured yet: {name}\n" for name in absent]
    parts += [f"Of no command in benchmarks/report/committed.py: {each}\n" for each in strangers]
    return "\n".join(parts)


@click.command()
@click.option("--markdown", is_flag=True, help="Tables for a document.")
def main(markdown: bool) -> None:
    """Print the age of every committed result, and every target that is missed."""
    there = committed(HERE, FOLDER)
    if not there:
        click.echo("no committed results: expected a git repository around benchmarks/")
        return
    click.echo(lines(there, table if markdown else columns), nl=False)


if __name__ == "__main__":
    main()
