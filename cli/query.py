"""`nisp query`: distance, chart, UV and color at points."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING

import click

from .files import output_option

if TYPE_CHECKING:
    from nispcodec.core.arrays import AnyArray, Float64Array

    Answers = dict[str, AnyArray]

COLUMNS = "x,y,z,sdf,chart,u,v,red,green,blue,alpha"


@click.command("query", short_help="Distance, chart, UV and color at points.")
@click.argument("model", type=click.Path(path_type=Path))
@click.argument("points", type=click.Path(path_type=Path))
@output_option(".npz", ".csv")
@click.option(
    "--frame", type=click.Choice(["world", "normalized"]), default="world", show_default=True
)
def command(model: Path, points: Path, output: Path, frame: str) -> None:
    """Ask MODEL (.nisp) at POINTS: an .npy of shape (n, 3), or a .csv of x,y,z rows.

    Answers sdf (n,), chart (n,), uv (n, 2) and color (n, 4); a .csv gets one row a point.

    \b
    Example: nisp query model.nisp points.npy -o answers.npz
    """
    import nispcodec
    from nispcodec.core.atomic_write import write_atomic

    asked = read_points(points)
    loaded = nispcodec.load(model)
    answers: Answers = {
        "sdf": loaded.sdf(asked, frame),
        "chart": loaded.charts(asked, frame),
        "uv": loaded.uv(asked, frame),
        "color": loaded.color(asked, frame),
    }
    write = _csv if output.suffix.lower() == ".csv" else _npz
    write_atomic(output, write(asked, answers))
    click.echo(f"{output}: {len(asked):,} points")


def read_points(path: Path) -> Float64Array:
    """(n, 3) float64 from an .npy or a .csv with or without a header line.

    Raises QueryError, naming the file, for anything else.
    """
    import numpy as np

    from nispcodec.core.errors import QueryError

    readers = {".npy": _read_npy, ".csv": _read_csv}
    suffix = path.suffix.lower()
    if suffix not in readers:
        raise QueryError(f"{path}: expected .npy or .csv, found {suffix or 'no suffix'}")
    try:
        points = readers[suffix](path)
    except (ValueError, EOFError) as error:
        raise QueryError(f"{path}: expected rows of three numbers, found: {error}") from error
    if points.ndim != 2 or points.shape[1] != 3 or points.dtype.kind not in "fiu":
        raise QueryError(
            f"{path}: expected numbers of shape (n, 3), found {points.dtype} of {points.shape}"
        )
    return points.astype(np.float64)


def _read_npy(path: Path) -> AnyArray:
    import numpy as np

    with path.open("rb") as file:
        return np.lib.format.read_array(file, allow_pickle=False)


def _read_csv(path: Path) -> AnyArray:
    import numpy as np

    lines = path.read_text(encoding="utf-8").splitlines()
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
