"""One point of a rate-distortion curve: encode, decode the written bytes, measure."""

from __future__ import annotations

from dataclasses import asdict

from benchmarks.assets.source import Source
from benchmarks.codecs import Setting, codec
from benchmarks.measuring.isolated import WorkFailed, isolated
from benchmarks.measuring.machine import commit
from benchmarks.measuring.result_file import Record


def measured(source: Source, name: str, setting: Setting) -> tuple[Record, bytes]:
    """The record of a point, and the file that was measured; a failure is a record too."""
    record: Record = {"asset": source.name, "codec": name, "setting": setting, "commit": commit()}
    coder, data = codec(name), b""
    # Known before the forks, so that no fork works it out for itself alone.
    reference, _ = source.reference, source.outer_faces
    try:
        data, cost = isolated(lambda: coder.encode(source, setting))
        record |= {"bytes": len(data), "encode": asdict(cost)}
        faces, cost = isolated(lambda: len(coder.decode(data, source).faces))
        record |= {"faces": faces, "decode": asdict(cost)}
        metrics, _ = isolated(lambda: reference.compare(coder.decode(data, source)))
        record |= {"metrics": metrics}
    except WorkFailed as why:
        record |= {"failure": str(why)}
    return record, data
