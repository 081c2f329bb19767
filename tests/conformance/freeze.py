"""Freezes the conformance files for ever: `python -m tests.conformance.freeze [--replace]`.

Copies the corpus, answers and malformed files included, to `v1.0/` beside it, with `SHA256SUMS` as
`sha256sum --check` reads it. Every reader of a later version must decode what is there. `--replace`
freezes again what was frozen before: only before a release.
"""

from __future__ import annotations

import hashlib
import shutil
import sys
from pathlib import Path

HERE = Path(__file__).parent
FROZEN = HERE / "v1.0"
LIST = "SHA256SUMS"


def corpus(folder: Path) -> list[Path]:
    """The files of a corpus, relative to its folder, sorted."""
    inside = [*folder.glob("*.nisp"), *folder.glob("*.json"), *folder.glob("malformed/*")]
    return sorted(path.relative_to(folder) for path in inside)


def sums(folder: Path) -> str:
    """A line for each file: its SHA-256 and its path."""
    lines = [
        f"{hashlib.sha256((folder / path).read_bytes()).hexdigest()}  {path.as_posix()}"
        for path in corpus(folder)
    ]
    return "\n".join(lines) + "\n"


def freeze(source: Path, target: Path) -> None:
    """Write the frozen copy, in place of another."""
    shutil.rmtree(target, ignore_errors=True)
    for path in corpus(source):
        (target / path).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source / path, target / path)
    (target / LIST).write_text(sums(target))


def main(arguments: list[str]) -> int:
    """Freeze, unless it was done and may not be done again; the exit code."""
    if FROZEN.exists() and "--replace" not in arguments:
        print(f"{FROZEN}: expected nothing frozen yet, or --replace before a release")
        return 1
    freeze(HERE, FROZEN)
    print(f"{FROZEN}: {len(corpus(FROZEN))} files frozen")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
