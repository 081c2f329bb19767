"""`nisp query`: distance, chart, UV and color at points."""

from __future__ import annotations

import io
from collections.abc import Iterator
from itertools import chain, islice
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

import click

from .choices import LibraryChoice, frames
from .outputs import OutputOrDash, Sink, output_option, refuse_overwriting
from .report import print_json
from .sources import Source, SourceFile, model_argument, parsed
from .subcommand import force_option, json_option, subcommand

if TYPE_CHECKING:
    from nispcodec.core.arrays import AnyArray, Float64Array
    from nispcodec.core.document import Document

    Answers = dict[str, AnyArray]

PART = 1 << 18
"""Rows that are read or written at a time: as text they take many times the memory."""
COLUMNS = "x,y,z,sdf,chart,u,v,red,green,blue,alpha"


def _suffixes() -> tuple[str, ...]:
    return (".npz", ".csv")


@subcommand("query", "Distance, chart, UV and color at points.")
@model_argument
@click.argument("points", type=SourceFile())
@output_option(OutputOrDash(_suffixes))
@click.option("--frame", type=LibraryChoice(frames), default="world", show_default=True)
@force_option
@json_option
def command(
    model: Source, points: Source, output: Sink, frame: str, force: bool, as_json: bool
) -> None:
    """Ask MODEL (.nisp) at POINTS: an .npy of shape (n, 3), or a .csv of x,y,z rows.

    Answers sdf (n,), chart (n,), uv (n, 2) and color (n, 4); a .csv gets one row a point.
    MODEL or POINTS may be - for standard input, points as CSV. With -o - the answers go to standard
    output as CSV, or as JSON with --json.

    \b
    Example: nisp query model.nisp points.npy -o answers.npz
             echo 0,0,0 | nisp query model.nisp - -o -
    """
    if model.path is None and points.path is None:
        raise click.UsageError("MODEL and POINTS: expected one from standard input, found both")
    refuse_overwriting([output.path] if output.path else [], force)
    document = parsed(model.read(), model)
    asked = read_points(points)
    answers = _answers(document, asked, frame)
    if as_json and output.path is None:
        print_json({name: values.tolist() for name, values in answers.items()})
        return
    write = _write_npz if output.suffix == ".npz" else _write_csv
    output.write(lambda file: write(file, asked, answers))
    if output.path:
        _report(output.path, len(asked), as_json)


def _report(path: Path, points: int, as_json: bool) -> None:
    from nispcodec.core.counted import counted

    size = path.stat().st_size
    if as_json:
        print_json({"file": str(path), "points": points, "bytes": size})
    else:
        click.echo(f"{path}: {counted(points, 'point')}, {size:,} bytes")


def _answers(document: Document, points: AnyArray, frame: str) -> Answers:
    from nispcodec.model import NispModel

    model = NispModel(document)
    charts = model.charts(points, frame)
    return {
        "sdf": model.sdf(points, frame),
        "chart": charts,
        "uv": model.uv(points, frame, charts),
        "color": model.color(points, frame),
    }


def _parts(count: int) -> Iterator[slice]:
    return (slice(start, start + PART) for start in range(0, count, PART))


def read_points(source: Source) -> AnyArray:
    """(n, 3) numbers from an .npy or a .csv with or without a header line; CSV from a pipe.

    An .npy is not read but mapped. Raises QueryError, naming the file, for anything else.
    """
    from nispcodec.core.errors import QueryError

    readers = {".npy": _map_npy, ".csv": _read_csv}
    suffix = source.path.suffix.lower() if source.path else ".csv"
    if suffix not in readers:
        raise QueryError(f"{source}: expected .npy or .csv, found {suffix or 'no suffix'}")
    try:
        points = readers[suffix](source)
    except (ValueError, EOFError) as error:
        raise QueryError(f"{source}: expected rows of three numbers, found: {error}") from error
    if points.ndim != 2 or points.shape[1] != 3 or points.dtype.kind not in "fiu":
        raise QueryError(
            f"{source}: expected numbers of shape (n, 3), found {points.dtype} of {points.shape}"
        )
    return points


def _map_npy(source: Source) -> AnyArray:
    import numpy as np

    with source.opened() as file:
        return np.load(file.name, mmap_mode="r", allow_pickle=False)


def _read_csv(source: Source) -> AnyArray:
    import numpy as np

    parts: list[Float64Array] = []
    with source.opened() as file:
        lines: Iterator[str] = io.TextIOWrapper(file, encoding="utf-8-sig")
        first = next(lines, "")
        if not any(letter in "xyzXYZ" for letter in first):
            lines = chain([first], lines)
        while part := list(islice(lines, PART)):
            rows = [line.split(",") for line in part if line.strip()]
            if rows:
                parts.append(np.array(rows, dtype=np.float64))
    return np.concatenate(parts) if parts else np.zeros((0, 0))


def _write_npz(file: BinaryIO, points: AnyArray, answers: Answers) -> None:
    import numpy as np

    np.savez(file, allow_pickle=False, **answers)


def _write_csv(file: BinaryIO, points: AnyArray, answers: Answers) -> None:
    import numpy as np

    formats = ["%.9g"] * 4 + ["%d"] + ["%.9g"] * 6
    file.write(f"{COLUMNS}\n".encode())
    for part in _parts(len(points)):
        table = np.column_stack([points[part], *(each[part] for each in answers.values())])
        np.savetxt(file, table, fmt=formats, delimiter=",")
