"""Writes the conformance files: `python -m tests.conformance.regenerate [--replace]`.

Without `--replace` it only adds what is missing: the committed bytes must decode for ever.
"""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path
from typing import Any

import numpy as np

from nispcodec.core.arrays import BoolArray, Float32Array
from nispcodec.core.document import Frame
from nispcodec.format import unpack
from nispcodec.infer.evaluate import evaluate
from nispcodec.model import NispModel
from tests.conformance.described import described
from tests.conformance.features import features
from tests.conformance.independent import Reader
from tests.conformance.malformed import all_malformed

HERE = Path(__file__).parent
TOLERANCE = {"sdf": 1e-4, "uv": 1e-4, "color": 0.01, "logit_margin": 1e-3}
POINTS = 8
DIGITS = 9
GRID = 1024


def answers(data: bytes) -> dict[str, Any]:
    """What the specification says about a file, in float64, at points that no rounding can turn.

    Points are multiples of 1 / GRID, which every float holds.
    """
    reader, frame = Reader(data), unpack(data).frame
    points = np.rint(np.random.default_rng(7).uniform(-0.8, 0.8, (400, 3)) * GRID) / GRID
    points = points[_steady(reader, NispModel(unpack(data)), points.astype(np.float32))][:POINTS]
    charts = [reader.chart(point) for point in points.tolist()]
    pairs = list(zip(points.tolist(), charts, strict=True))
    found: dict[str, Any] = {
        "document": described(reader),
        "points": points.tolist(),
        "sdf": [reader.distance(point) for point, _ in pairs],
        "chart": charts,
        "uv": [reader.uv(point, chart) for point, chart in pairs],
        "color": [reader.color(point) for point, _ in pairs],
    }
    if frame != Frame((0.0, 0.0, 0.0), 1.0):
        world = [distance * frame.radius for distance in found["sdf"]]
        found |= {"world_points": frame.to_world(points).tolist(), "world_sdf": world}
    return found


def _steady(reader: Reader, model: NispModel, points: Float32Array) -> BoolArray:
    """(n,) bool: clear of borders of charts (or right on one, in a tie) and of texels."""
    steady = np.ones(len(points), np.bool_)
    if "chart" in model.document.networks:
        logits = np.sort(evaluate(model.document.networks["chart"], points), axis=1)
        margin = logits[:, -1] - logits[:, -2]
        steady &= (margin > 0.01) | (margin == 0) | np.isnan(margin)
    if model.document.textures:
        steady &= np.array([_clear_of_texels(reader, point) for point in points.tolist()])
    return steady


def _clear_of_texels(reader: Reader, point: list[float]) -> bool:
    """Whether the place in every texture is clear of the middle between two texels, and of them."""
    chart = reader.chart(point, int(reader.meta["openings"]))
    uv = reader.uv(point, chart)
    if not reader.meta["chart_has_uv"][chart] or not all(map(math.isfinite, uv)):
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
