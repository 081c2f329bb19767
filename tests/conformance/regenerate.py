"""Writes the conformance files: `python -m tests.conformance.regenerate [--replace]`.

Without `--replace` it only adds what is missing: the committed bytes must decode for ever.
"""

from __future__ import annotations

import json
import math
import sys
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from nispcodec.core.arrays import BoolArray, Float32Array, Float64Array
from nispcodec.core.document import Frame
from nispcodec.format import unpack
from nispcodec.infer.evaluate import evaluate
from nispcodec.model import NispModel
from tests.conformance.described import described
from tests.conformance.features import features
from tests.conformance.independent import DECODER, Reader
from tests.conformance.malformed import all_malformed

HERE = Path(__file__).parent
TOLERANCE = {
    "sdf": 1e-4,
    "mesh_sdf": 1e-5,
    "normal": 1e-3,
    "uv": 1e-4,
    "color": 0.01,
    "logit_margin": 1e-3,
}
APART = 1e-3
"""By how much distances differ at least, and how far points are from the surface."""
UV_APART = 1e-5
POINTS = 8
DIGITS = 9
GRID = 1024


def answers(data: bytes) -> dict[str, Any]:
    """What the specification says about a file, in float64, at points that no rounding can turn.

    Points are multiples of 1 / GRID, which every float holds.
    """
    reader, frame = Reader(data), unpack(data).frame
    points = np.rint(_candidates(reader) * GRID) / GRID
    points = points[_steady(NispModel(unpack(data)), points.astype(np.float32))]
    clear = (point for point in points.tolist() if _is_clear(reader, point))
    points = np.array(list(islice(clear, POINTS)))
    charts = [reader.chart(point) for point in points.tolist()]
    pairs = list(zip(points.tolist(), charts, strict=True))
    found: dict[str, Any] = {
        "document": described(reader),
        "points": points.tolist(),
        "sdf": [reader.distance(point) for point, _ in pairs],
        "normal": [reader.normal(point) for point, _ in pairs],
        "chart": charts,
        "uv": [reader.uv(point, chart) for point, chart in pairs],
        "color": [reader.color(point) for point, _ in pairs],
    }
    if reader.parts:
        others = [_other(reader, chart) for chart in charts]
        found["other_chart"] = others
        found["other_uv"] = [reader.uv(p, c) for p, c in zip(points.tolist(), others, strict=True)]
    if frame != Frame((0.0, 0.0, 0.0), 1.0):
        world = [distance * frame.radius for distance in found["sdf"]]
        found |= {"world_points": frame.to_world(points).tolist(), "world_sdf": world}
    return found


def _candidates(reader: Reader) -> Float64Array:
    """(n, 3): anywhere, and of three points two near a triangle of mesh parts if there are any."""
    generator = np.random.default_rng(7)
    anywhere = generator.uniform(-0.8, 0.8, (400, 3))
    if not reader.parts:
        return anywhere
    corners = np.array(reader.mesh.corners)[generator.integers(0, len(reader.mesh.corners), 800)]
    weights = generator.dirichlet((1, 1, 1), 800)
    near = np.einsum("nk,nkd->nd", weights, corners) + generator.normal(0, 0.06, (800, 3))
    mixed: Float64Array = np.stack([anywhere, near[:400], near[400:]], axis=1).reshape(-1, 3)
    return mixed


def _other(reader: Reader, chart: int) -> int:
    """The mesh part's chart after this one, the last followed by the first."""
    first, count = reader.k, len(reader.mesh.chart_materials)
    return first + (max(chart - first, -1) + 1) % count


def _steady(model: NispModel, points: Float32Array) -> BoolArray:
    """(n,) bool: clear of borders of the field's charts, or right on one, in a tie."""
    steady = np.ones(len(points), np.bool_)
    if "chart" in model.document.networks:
        logits = np.sort(evaluate(model.document.networks["chart"], points), axis=1)
        margin = logits[:, -1] - logits[:, -2]
        steady &= (margin > 0.01) | (margin == 0) | np.isnan(margin)
    return steady


def _is_clear(reader: Reader, point: list[float]) -> bool:
    """Whether no rounding changes the place on mesh parts and in textures."""
    ties = bool(reader.parts) and not _clear_of_ties(reader, point)
    return not ties and (not reader.files or _clear_of_texels(reader, point))


def _clear_of_ties(reader: Reader, point: list[float]) -> bool:
    """Whether it is clear what is nearest of field and mesh parts, where on these, which side."""
    field, mesh = (abs(each) for each in reader.distances(point))
    other = _other(reader, reader.chart(point))
    return (
        abs(field - mesh) > APART
        and mesh > APART
        and _inside_is_clear(reader, point)
        and _one_place(reader, point, None)
        and _one_place(reader, point, other - reader.k)
    )


def _inside_is_clear(reader: Reader, point: list[float]) -> bool:
    """Whether the winding number is far from where inside begins."""
    triangles = zip(reader.mesh.corners, reader.mesh.sheet, strict=True)
    bodies = [corners for corners, sheet in triangles if not sheet]
    angles = sum(DECODER["solid_angle"](corners, point) for corners in bodies)
    return abs(abs(angles) / (4 * math.pi) - 0.5) > 0.05


def _one_place(reader: Reader, point: list[float], chart: int | None) -> bool:
    """Whether all triangles that are about as near as the nearest have its chart and UV."""
    mesh = reader.mesh
    nearest, number, weights = mesh.ask(point, chart)
    place = mesh.charts[number], mesh.uv_of(number, weights)
    for other, corners in enumerate(mesh.corners):
        share = DECODER["closest_weights"](corners, point)
        distance = DECODER["distance"](corners, share, point)
        if chart not in (None, mesh.charts[other]) or distance > abs(nearest) + APART:
            continue
        found = mesh.charts[other], mesh.uv_of(other, share)
        near = distance < abs(nearest) + APART / 10
        if found[0] != place[0] or (near and math.dist(found[1], place[1]) > UV_APART):
            return False
    return True


def _clear_of_texels(reader: Reader, point: list[float]) -> bool:
    """Whether the place in every texture is clear of the middle between two texels, and of them."""
    chart = reader.chart(point, int(reader.meta["openings"]))
    uv = reader.uv(point, chart)
    if not reader.chart_has_uv[chart] or not all(map(math.isfinite, uv)):
        return True
    images = [reader.image(number) for number in range(len(reader.files))]
    sizes = [(len(image[0]), len(image)) for image in images]
    return all(abs(t * n % 1 - 0.5) < 0.48 for size in sizes for t, n in zip(uv, size, strict=True))


def main(replace: bool) -> None:
    """Write all files."""
    for name, data in features():
        path = HERE / f"{name}.nisp"
        if replace or not path.exists():
            path.write_bytes(data)
            path.with_suffix(".json").write_text(_compact(answers(data)))
    (HERE / "tolerance.json").write_text(json.dumps(TOLERANCE, indent=1) + "\n")
    folder = HERE / "malformed"
    folder.mkdir(exist_ok=True)
    expected = {}
    for case in all_malformed():
        expected[case.name] = {"section": case.section, "field": case.field}
        path = folder / f"{case.name}.nisp"
        if replace or not path.exists():
            path.write_bytes(case.data)
    (folder / "expected.json").write_text(json.dumps(expected, indent=1, sort_keys=True) + "\n")


def _compact(answer: dict[str, Any]) -> str:
    """One line for each kind of answer, floats of answers to `DIGITS` digits."""
    whole = ("document", "points", "world_points")
    short = {k: v if k in whole else _short(v) for k, v in answer.items()}
    rows = [f'"{name}": {json.dumps(value)}' for name, value in short.items()]
    return "{\n" + ",\n".join(rows) + "\n}\n"


def _short(value: Any) -> Any:
    if isinstance(value, list):
        return [_short(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return {math.inf: "Infinity", -math.inf: "-Infinity"}.get(value, "NaN")
    return value if isinstance(value, int) else float(f"{value:.{DIGITS}g}")


if __name__ == "__main__":
    main("--replace" in sys.argv[1:])
