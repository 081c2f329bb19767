"""A build of `nisp` that a benchmark runs as a program: of this tree or another, of any commit."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from benchmarks.measuring.machine import commit

HERE = Path(__file__).parents[2]
LAUNCHER = Path(__file__).with_name("nisp_from_tree.py")

# PYTHONDONTWRITEBYTECODE would have every start compile the sources again, which no user's does.
DROPPED = {"PYTHONPATH", "PYTHONHOME", "PYTHONDONTWRITEBYTECODE"}


@dataclass(frozen=True)
class Build:
    """`command` is what `nisp` is called by, in `environment`; `name` tells builds apart."""

    name: str
    command: tuple[str, ...]
    environment: Mapping[str, str]


def build_at(place: Path, python: Path | None = None) -> Build:
    """The build of a tree, or of the environment whose interpreter is given in its place.

    A tree is run by `python`; by its own .venv where none is given, by our interpreter where it
    has none. Raises FileNotFoundError where there is no build.
    """
    if place.is_dir():
        return _of_tree(place.resolve(), python)
    return _installed(place.absolute())


def _of_tree(tree: Path, python: Path | None) -> Build:
    _expect(tree / "cli" / "__init__.py")
    own = tree / ".venv" / "bin" / "python"
    # Not resolved: an environment's interpreter is a link, and is known by the link's place.
    chosen = python.absolute() if python else own if own.exists() else Path(sys.executable)
    _expect(chosen)
    command = (str(chosen), str(LAUNCHER), str(tree))
    return Build(commit(tree), command, _environment() | {"PYTHONPATH": str(tree)})


def _installed(python: Path) -> Build:
    nisp = _expect(_expect(python).with_name("nisp"))
    return Build(f"installed in {python.parents[1]}", (str(nisp),), _environment())


def _environment() -> dict[str, str]:
    return {name: value for name, value in os.environ.items() if name not in DROPPED}


def _expect(path: Path) -> Path:
    if not path.exists():
        raise FileNotFoundError(f"{path}: expected a file of a build of nisp, found none")
    return path
