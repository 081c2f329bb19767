"""Finished points, one JSON file each, so that an interrupted run goes on where it stopped."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.codecs import Setting
from nispcodec.output import write_atomic

Record = dict[str, Any]


@dataclass(frozen=True)
class Store:
    """A folder of ASSET/CODEC/SETTING.json, each with the measured file beside it as .bin."""

    folder: Path

    def path(self, asset: str, codec: str, setting: Setting) -> Path:
        """Where the record of a point is or will be."""
        label = ",".join(f"{name}={value}" for name, value in setting.items()) or "default"
        return self.folder / asset / codec / f"{label}.json"

    def holds(self, asset: str, codec: str, setting: Setting) -> bool:
        """Whether the point is finished; one that failed is not."""
        path = self.path(asset, codec, setting)
        return path.exists() and "failure" not in json.loads(path.read_text())

    def put(self, record: Record, data: bytes) -> None:
        """Keep a record and its file."""
        path = self.path(record["asset"], record["codec"], record["setting"])
        path.parent.mkdir(parents=True, exist_ok=True)
        write_atomic(path.with_suffix(".bin"), data)
        write_atomic(path, json.dumps(record).encode())

    def records(self) -> list[Record]:
        """All records, by asset, codec and setting."""
        return [json.loads(path.read_text()) for path in sorted(self.folder.glob("*/*/*.json"))]

    def file(self, record: Record) -> Path:
        """The file that was measured."""
        return self.path(record["asset"], record["codec"], record["setting"]).with_suffix(".bin")
