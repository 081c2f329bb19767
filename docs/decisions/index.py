"""Write the index of the decision records into README.md beside them.

python docs/decisions/index.py           rewrites the table
python docs/decisions/index.py --check   exits with 1 where the table is stale
"""

from __future__ import annotations

import re
import sys
from dataclasses import dataclass
from pathlib import Path

FOLDER = Path(__file__).parent
START, END = "<!-- index: python docs/decisions/index.py -->\n", "<!-- end of index -->\n"
HEAD = "| number | decision | date | status |\n| --- | --- | --- | --- |\n"

TITLE = re.compile(r"# (\d{4}): (\S.*)")
DATE = re.compile(r"- Date: (\S+)")
STATUS = re.compile(r"- Status: (\S.*)")


@dataclass(frozen=True)
class Record:
    """The head of a decision record; `status` is Markdown, with links relative to the folder."""

    name: str
    number: int
    title: str
    date: str
    status: str

    @property
    def row(self) -> str:
        """Its line of the index."""
        title = self.title.replace("|", r"\|")
        return f"| [{self.number:04}]({self.name}) | {title} | {self.date} | {self.status} |\n"


def record_of(path: Path) -> Record:
    """Read the head of one record. Raises ValueError, naming file and line, where it has none."""
    lines = path.read_text(encoding="utf-8").splitlines()
    title = _matched(TITLE, lines, 0, path)
    date, status = _matched(DATE, lines, 2, path), _matched(STATUS, lines, 3, path)
    return Record(path.name, int(title[1]), title[2], date[1], status[1])


def records(folder: Path = FOLDER) -> list[Record]:
    """All records of a folder, by file name; README.md and template.md are none."""
    return [record_of(path) for path in sorted(folder.glob("[0-9]*.md"))]


def refreshed(page: str, entries: list[Record]) -> str:
    """The page with these records in its table. Raises ValueError where it has no markers."""
    before, start, rest = page.partition(START)
    _, end, after = rest.partition(END)
    if not start or not end:
        raise ValueError(f"README.md: expected the lines {START.strip()} and {END.strip()}")
    return before + START + HEAD + "".join(entry.row for entry in entries) + END + after


def main(arguments: list[str]) -> None:
    """Rewrite the index, or only say whether it is fresh."""
    path = FOLDER / "README.md"
    page = path.read_text(encoding="utf-8")
    fresh = refreshed(page, records())
    if arguments == ["--check"]:
        sys.exit(None if page == fresh else f"{path} is stale: run python docs/decisions/index.py")
    path.write_text(fresh, encoding="utf-8")


def _matched(pattern: re.Pattern[str], lines: list[str], at: int, path: Path) -> re.Match[str]:
    line = lines[at] if at < len(lines) else ""
    match = pattern.fullmatch(line)
    if match is None:
        raise ValueError(f"{path.name}:{at + 1}: expected {pattern.pattern!r}, found {line!r}")
    return match


if __name__ == "__main__":
    main(sys.argv[1:])
