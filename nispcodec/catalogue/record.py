"""A record: what is known of one asset of a catalogue, and its line in `catalogue.jsonl`."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from typing import Any

DONE, FAILED = "done", "failed"

# Kinds of failure. A transient one may end otherwise when it is tried again.
INPUT, CRASH, TIMEOUT, MEMORY, DISK, STORAGE, BUG = (
    "input", "crash", "timeout", "memory", "disk", "storage", "bug",
)  # fmt: skip
TRANSIENT = (CRASH, STORAGE)
REQUIRED = ("source", "output", "status")
"""Members that every line has."""


@dataclass(frozen=True)
class Record:
    """One asset: what it was made from, what came, or why nothing did.

    source    path or URL of the mesh file, as it was found
    output    of the `.nisp`, relative to the folder of the catalogue, with slashes; "" for what
              could not become an asset at all
    status    "done" or "failed"
    content   SHA-256 of `inputs`
    inputs    SHA-256 of every file that was read, by its path relative to the mesh file's folder;
              None for a file that the asset names and that is not there
    settings  SHA-256 of all that was asked and changes bytes
    options   of these, what is not the default
    sha256    of the output
    bytes     geometry_uv, textures, total; input_mesh, input_textures
    errors    as `nisp encode` measures them, and, if asked for, `nisp compare`
    seconds   encode, all
    kind      of a failure: "input", "crash", "timeout", "memory", "disk", "storage", "bug"
    error     one sentence
    tries     how often it was begun
    """

    source: str
    output: str
    status: str
    content: str = ""
    settings: str = ""
    sha256: str = ""
    inputs: Mapping[str, str | None] = field(default_factory=dict)
    options: Mapping[str, Any] = field(default_factory=dict)
    bytes: Mapping[str, int] = field(default_factory=dict)
    errors: Mapping[str, float] = field(default_factory=dict)
    seconds: Mapping[str, float] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    kind: str = ""
    error: str = ""
    tries: int = 1
    nispcodec: str = ""

    @property
    def done(self) -> bool:
        """Whether the output was written and verified."""
        return self.status == DONE

    @property
    def transient(self) -> bool:
        """Whether another try may end otherwise."""
        return self.kind in TRANSIENT

    @property
    def saved(self) -> int:
        """Bytes that the output has less than its input; negative where it has more."""
        known = self.bytes.get
        return known("input_mesh", 0) + known("input_textures", 0) - known("total", 0)

    def line(self) -> str:
        """The record as JSON, without a line's end; what is empty is left out."""
        told = {name: value for name, value in asdict(self).items() if value or name in REQUIRED}
        return json.dumps(told)


def failed(source: str, output: str, kind: str, error: str) -> Record:
    """The record of an asset that came to nothing."""
    return Record(source, output, FAILED, kind=kind, error=error)


def parsed(line: str) -> Record:
    """The record of a line. Raises ValueError, in words, for a line that is none."""
    try:
        found = json.loads(line)
    except (ValueError, RecursionError) as why:
        raise ValueError(f"expected JSON, found {line[:40]!r}") from why
    if not isinstance(found, dict):
        raise ValueError(f"expected an object, found {line[:40]!r}")
    known = {name: value for name, value in found.items() if name in _TYPES}
    for name, value in known.items():
        if not isinstance(value, _TYPES[name]):
            raise ValueError(f"{name}: expected {_TYPES[name]}, found {value!r}")
    if missing := [name for name in REQUIRED if name not in known]:
        raise ValueError(f"expected {', '.join(missing)}, found none")
    record = Record(**known)
    return replace(record, warnings=tuple(map(str, record.warnings)))


# What JSON has for each member.
_JSON = {"str": str, "int": int, "tuple": list, "Mapping": dict}
_TYPES: dict[str, type] = {
    each.name: _JSON[str(each.type).partition("[")[0]] for each in fields(Record)
}
