"""Result files: JSON that a command writes, reads to go on, and that is committed."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from nispcodec.core.atomic_write import write_atomic

Record = dict[str, Any]


def as_json(result: Mapping[str, object]) -> str:
    """The text of a result file, without the last line's end."""
    return json.dumps(result, indent=1)


def write_result(path: Path, result: Mapping[str, object]) -> None:
    """Write the file, whole or not at all, and its folder where there is none."""
    path.parent.mkdir(parents=True, exist_ok=True)
    write_atomic(path, f"{as_json(result)}\n".encode())


def read_result(path: Path) -> Record:
    """What the file holds. Raises FileNotFoundError where there is none."""
    found: Record = json.loads(path.read_text(encoding="utf-8"))
    return found


def result_so_far(path: Path) -> Record:
    """What an earlier run has left, to go on with; empty where there is no file."""
    return read_result(path) if path.exists() else {}


def commits_of(result: Any) -> Iterator[str]:
    """Every commit that a result or a record in it names, the same one more than once."""
    values = result.values() if isinstance(result, dict) else result
    if isinstance(result, dict) and isinstance(result.get("commit"), str):
        yield result["commit"]
    for value in values:
        if isinstance(value, dict | list):
            yield from commits_of(value)
