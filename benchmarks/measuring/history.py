"""What git says of the commits that results were measured at."""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from pathlib import Path

CHANGES = "+changes"


def committed(tree: Path, folder: str) -> list[str]:
    """The names of the committed files in a folder of a tree; none where git is missing."""
    paths = [tree / line for line in _asked(tree, "ls-files", "--", folder).splitlines()]
    return [path.name for path in paths if path.exists()]


def commits_since(tree: Path, commit: str, paths: Sequence[str]) -> int | None:
    """How many commits after this one touch any of the paths; None where it is not known here.

    Paths may be of any time: a folder that was renamed has its former name among them.
    """
    known = commit.removesuffix(CHANGES)
    answer = _asked(tree, "rev-list", "--count", f"{known}..HEAD", "--", *paths)
    return int(answer) if answer else None


def date_of(tree: Path, commit: str) -> str | None:
    """YYYY-MM-DD; None where the commit is not known here."""
    return _asked(tree, "show", "-s", "--format=%cs", commit.removesuffix(CHANGES), "--") or None


def _asked(tree: Path, *words: str) -> str:
    """git's answer, empty when there is none: no such commit, no repository, no git."""
    command = ["git", "-C", str(tree), *words]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return ""
    return done.stdout.strip()
