"""`nisp query`: distance, chart, UV and color at points."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING

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
    output.write((_npz if output.suffix == ".npz" else _csv)(asked, answers))
    if output.path:
        _report(output.path, len(asked), as_json)


def _report(path: Path, points: int, as_json: bool) -> None:
    size = path.stat().st_size
    if as_json:
        print_json({"file": str(path), "points": points, "bytes": size})
    else:
        click.echo(f"{path}: {points:,} points, {size:,} bytes")


def _answers(document: Document, points: Float64Array, frame: str) -> Answers:
    from nispcodec.model import NispModel

    model = NispModel(document)
    charts = model.charts(points, frame)
    return {
        "sdf": model.sdf(points, frame),
        "chart": charts,
        "uv": model.uv(points, frame, charts),
        "color": model.color(points, frame),
    }


def read_points(source: Source) -> Float64Array:
    """(n, 3) float64 from an .npy or a .csv with or without a header line; CSV from a pipe.

    Raises QueryError, naming the file, for anything else.
    """
    import numpy as np

    from nispcodec.core.errors import QueryError

    readers = {".npy": _read_npy, ".csv": _read_csv}
    suffix = source.path.suffix.lower() if source.path else ".csv"
    if suffix not in readers:
        raise QueryError(f"{source}: expected .npy or .csv, found {suffix or 'no suffix'}")
    data = source.read()
    try:
        points = readers[suffix](data)
    except (ValueError, EOFError) as error:
        raise QueryError(f"{source}: expected rows of three numbers, found: {error}") from error
    if points.ndim != 2 or points.shape[1] != 3 or points.dtype.kind not in "fiu":
        raise QueryError(
            f"{source}: expected numbers of shape (n, 3), found {points.dtype} of {points.shape}"
        )
    return points.astype(np.float64)


def _read_npy(data: bytes) -> AnyArray:
    import numpy as np

    return np.lib.format.read_array(io.BytesIO(data), allow_pickle=False)


def _read_csv(data: bytes) -> AnyArray:
    import numpy as np

    lines = data.decode("utf-8-sig").splitlines()
    has_header = bool(lines) and any(letter in "xyzXYZ" for letter in lines[0])
    rows = [line.split(",") for line in lines[has_header:] if line.strip()]
    return np.array(rows, dtype=np.float64).reshape(len(rows), -1)


def _npz(points: Float64Array, answers: Answers) -> bytes:
    import numpy as np

    buffer = io.BytesIO()
    np.savez(buffer, allow_pickle=False, **answers)
    return buffer.getvalue()


def _csv(points: Float64Array, answers: Answers) -> bytes:
    import numpy as np

    buffer = io.StringIO()
    table = np.column_stack([points, *answers.values()])
    formats = ["%.9g"] * 4 + ["%d"] + ["%.9g"] * 6
    np.savetxt(buffer, table, fmt=formats, delimiter=",", header=COLUMNS, comments="")
    return buffer.getvalue().encode()
