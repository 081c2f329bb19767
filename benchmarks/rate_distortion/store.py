"""Finished points, one JSON file each, so that an interrupted run goes on where it stopped."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

from benchmarks.codecs import Setting
from benchmarks.measuring.result_file import Record
from nispcodec.core.atomic_write import write_atomic


@dataclass(frozen=True)
class Store:
    """A folder of ASSET/CODEC/SETTING.json, each with the measured file beside it as .bin."""

    folder: Path

    def path(self, asset: str, codec: str, setting: Setting) -> Path:
        """Where the record of a point is or will be."""
        label = ",".join(f"{name}={value}" for name, value in setting.items()) or "default"
        return self.folder / asset / codec / f"{label}.json"

    def find(self, asset: str, codec: str, setting: Setting) -> Record | None:
        """The record of a point, if there is one."""
        path = self.path(asset, codec, setting)
        return json.loads(path.read_text()) if path.exists() else None

    def put(self, record: Record, data: bytes | None = None, picture: bytes | None = None) -> None:
        """Keep a record; its file and its picture stay as they were when they are None."""
        path = self.path(record["asset"], record["codec"], record["setting"])
        path.parent.mkdir(parents=True, exist_ok=True)
        for suffix, content in ((".bin", data), (".webp", picture)):
            if content is not None:
                write_atomic(path.with_suffix(suffix), content)
        write_atomic(path, json.dumps(record).encode())

    def records(self) -> list[Record]:
        """All records, by asset, codec and setting."""
        return [json.loads(path.read_text()) for path in sorted(self.folder.glob("*/*/*.json"))]

    def file(self, record: Record) -> bytes:
        """The file that was measured."""
        return self._beside(record, ".bin").read_bytes()

    def picture(self, record: Record) -> bytes | None:
        """What the decode looks like, if it was drawn: a WebP."""
        path = self._beside(record, ".webp")
        return path.read_bytes() if path.exists() else None

    def put_original(self, asset: str, picture: bytes) -> None:
        """Keep what the original looks like, for `original`."""
        write_atomic(self.folder / asset / "original.webp", picture)

    def original(self, asset: str) -> bytes | None:
        """What the original looks like, if it was drawn: a WebP."""
        path = self.folder / asset / "original.webp"
        return path.read_bytes() if path.exists() else None

    def _beside(self, record: Record, suffix: str) -> Path:
        path = self.path(record["asset"], record["codec"], record["setting"])
        return path.with_suffix(suffix)
