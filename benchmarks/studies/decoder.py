"""The decoder's numbers: queries, extraction, seams, color; against targets, peers and the paper.

    python -m benchmarks.studies.decoder --models DIR --assets ../shared/assets [--only spot]

DIR holds NAME.nisp for the assets NAME. Times are true only when the machine has nothing else to
do. Results are kept asset by asset; one that has a result for the same bytes is not measured again.
"""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from itertools import pairwise
from pathlib import Path

import click
import numpy as np

from benchmarks.headline.main_job import PRECISE
from benchmarks.measuring.field_of import field_of
from benchmarks.measuring.model_records import measured, models_options
from benchmarks.measuring.result_file import Record
from benchmarks.measuring.target import Asked, Target, asked_of_each
from benchmarks.studies.soundness import counted, two_chart_triangles
from nispcodec.core.arrays import Float32Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import Document
from nispcodec.core.network import Network, NetworkSpec
from nispcodec.extract.components import without_noise
from nispcodec.extract.isosurface import extract
from nispcodec.extract.meshing import textured_mesh
from nispcodec.format import unpack
from nispcodec.infer.evaluate import classify, evaluate
from nispcodec.infer.field import FieldQueries
from nispcodec.io.load import load_mesh
from nispcodec.metrics.compare import compare

POINTS = 400_000
REPEATS = 5
RESOLUTIONS = (256, 512, 1024)
# Seconds for 10,000 queries on an RTX 2070 SUPER (the paper, section 5).
PAPER = {"sdf_points_per_second": 10_000 / 0.3, "uv_points_per_second": 10_000 / 0.6}
START = """
import numpy, nispcodec, sys
model = nispcodec.load(sys.argv[1])
model.sdf(numpy.random.default_rng(0).uniform(-1, 1, (10_000, 3)))
assert "torch" not in sys.modules
"""

RESULTS = Path("benchmarks/results/decoder.json")

QUERIES = [
    Target("UV queries a second", ("uv_points_per_second",), 5e5, at_least=True),
    Target("SDF queries a second", ("sdf_points_per_second",), 1e6, at_least=True),
    Target("share of the peak", ("share_of_peak",), 0.4, at_least=True),
]
TARGETS = [
    Target("SDF queries / 8 x 64", ("times_8x64", "sdf"), 5, at_least=True),
    Target("UV queries / 8 x 64", ("times_8x64", "uv"), 5, at_least=True),
    *(
        target
        for size, seconds, memory in (("256", 3, 6e8), ("512", 10, 1e9), ("1024", 60, 3e9))
        for target in (
            Target(f"{size}: seconds", ("extraction", size, "mesh_seconds"), seconds),
            Target(f"{size}: bytes", ("extraction", size, "mesh_peak_bytes"), memory),
        )
    ),
    Target("growth to 512", ("extraction", "growth", "512"), 4.5),
    Target("growth to 1024", ("extraction", "growth", "1024"), 4.5),
    Target("across two charts", ("soundness", "two_chart_triangles"), 0),
    Target("cracks", ("soundness", "cracks"), 0),
    Target("duplicate vertices", ("soundness", "duplicate_vertices"), 0),
    Target("start, s", ("start_seconds",), 0.6),
]
COLOR = Target("color, dB", ("color", "psnr"), 30, at_least=True)


def targets(asset: str) -> list[Target]:
    """What is asked of an asset."""
    return [*TARGETS, COLOR] if asset in PRECISE else TARGETS


def asked(results: Record) -> Iterator[Asked]:
    """The targets of the queries, and of every asset in a result file."""
    plain = results["queries_8x64"]["plain"]
    yield from (Asked("8 x 64", target, plain) for target in QUERIES)
    yield from asked_of_each(results["assets"], targets)


def best_seconds(work: Callable[[], object], repeats: int = REPEATS) -> float:
    """The shortest of several runs, after one to warm up."""
    work()
    seconds = []
    for _ in range(repeats):
        started = time.perf_counter()
        work()
        seconds.append(time.perf_counter() - started)
    return min(seconds)


def matrix_peak() -> float:
    """FLOP/s of a large float32 matrix product with all of BLAS's threads."""
    size = 3072
    matrix = np.random.default_rng(0).normal(size=(size, size)).astype(np.float32)
    return 2 * size**3 / best_seconds(lambda: matrix @ matrix)


def random_network(spec: NetworkSpec) -> Network:
    """The topology with small normal weights: time does not depend on them."""
    rng = np.random.default_rng(0)
    shapes = spec.shapes.items()
    return Network(spec, {k: rng.normal(0, 0.05, s).astype(np.float32) for k, s in shapes})


def query_speed(sdf: Network, chart: Network | None, uv: Network | None) -> Record:
    """Points a second for the SDF alone, and for the predicted chart and its UV."""
    points = np.random.default_rng(0).uniform(-1, 1, (POINTS, 3)).astype(np.float32)
    seconds = best_seconds(lambda: evaluate(sdf, points))
    record: Record = {"sdf_points_per_second": round(POINTS / seconds)}
    record["sdf_flops"] = 2 * sdf.spec.weight_count * record["sdf_points_per_second"]
    if chart is not None and uv is not None:
        seconds = best_seconds(lambda: chart_and_uv(chart, uv, points))
        record["uv_points_per_second"] = round(POINTS / seconds)
    return record


def chart_and_uv(chart: Network, uv: Network, points: Float32Array) -> object:
    """What a UV query costs: the chart is predicted first."""
    charts = classify(chart, points)
    return evaluate(uv, points, charts if uv.spec.conditioning != "none" else None)


def paper_queries() -> Record:
    """8 x 64 networks, 30 Fourier inputs as published and 3 plain ones as in our presets."""
    wide = (64,) * 8
    charts = 16
    plain = query_speed(
        random_network(NetworkSpec(wide, 1)),
        random_network(NetworkSpec(wide, charts)),
        random_network(
            NetworkSpec(wide, 2, conditioning="chart_affine", charts=charts, embedding=4)
        ),
    )
    options: Record = {"encoding": "fourier", "levels": 5, "w0": 1.0}
    published = query_speed(
        random_network(NetworkSpec(wide, 1, **{**options, "activation": "relu"})),
        random_network(NetworkSpec(wide, charts, **options)),
        random_network(NetworkSpec(wide, 2, conditioning="scalar", charts=charts, **options)),
    )
    return {"plain": plain, "published": published}


def probe(model: Path, resolution: int, *options: str) -> Record:
    """One extraction in its own process."""
    module = [sys.executable, "-m", "benchmarks.studies.extraction_probe"]
    command = [*module, str(model), str(resolution), *options]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    answer: Record = json.loads(done.stdout)
    return answer


def middle_probe(model: Path, resolution: int) -> Record:
    """Of three extractions the one that took the median time."""
    runs = [probe(model, resolution) for _ in range(3)]
    return sorted(runs, key=lambda run: float(run["seconds"]))[1]


def extractions(model: Path) -> Record:
    """Every resolution and the growth between them; a plain decode's; the lowest the dense way."""
    runs = {str(resolution): middle_probe(model, resolution) for resolution in RESOLUTIONS}
    seconds = [run["seconds"] for run in runs.values()]
    growth = {
        size: round(after / before, 2)
        for size, (before, after) in zip(list(runs)[1:], pairwise(seconds), strict=True)
    }
    plain, dense = probe(model, 0), probe(model, RESOLUTIONS[0], "--dense")
    return runs | {"growth": growth, "default": plain, "dense_256": dense}


def start_seconds(model: Path) -> float:
    """Import, load and 10,000 queries as a whole process."""
    command = [sys.executable, "-c", START, str(model)]
    return round(best_seconds(lambda: subprocess.run(command, check=True)), 3)


def naive(document: Document, resolution: int) -> TexturedMesh:
    """One UV a vertex, as marching cubes alone gives it: smeared across every seam."""
    mesh, _ = textured_mesh(document, resolution)
    field = field_of(document)
    surface, _ = without_noise(field.sdf, extract(field.sdf, resolution))
    charts = np.zeros(len(surface.positions), np.int32)
    if field.chart is not None:
        charts = classify(field.chart, surface.positions)
    return replace(
        mesh,
        positions=document.frame.to_world(surface.positions),
        faces=surface.faces,
        uvs=FieldQueries(field).uv(surface.positions, charts).astype(np.float64),
        uv_faces=surface.faces,
        face_materials=field.charts.materials[charts[surface.faces[:, 0]]].astype(np.int32),
    )


def fidelity(document: Document, original: TexturedMesh) -> Record:
    """Soundness of the mesh of a plain decode, its distortion, the color of the naive one."""
    mesh, report = textured_mesh(document)
    measured = compare(original, mesh)
    record = {
        "resolution": report.resolution,
        "soundness": counted(document),
        "geometry": measured["geometry"],
    }
    if field_of(document).uv is None:
        return record
    smeared = naive(document, report.resolution)
    color, plain = measured["color"], compare(original, smeared)["color"]
    return record | {
        "uv": measured["uv"],
        "color": color,
        "color_naive": plain,
        "two_chart_triangles_naive": two_chart_triangles(document, smeared),
    }


def measured_asset(model: Path, source: Path, wide: Record) -> Record:
    """Everything about one asset; `wide` is the query speed of 8 x 64 networks."""
    document = unpack(model.read_bytes())
    field = field_of(document)
    queries = query_speed(field.sdf, field.chart, field.uv)
    speeds = {name: f"{name}_points_per_second" for name in ("sdf", "uv")}
    return {
        "queries": queries,
        "times_8x64": {
            name: round(queries[speed] / wide[speed], 2)
            for name, speed in speeds.items()
            if speed in queries
        },
        "start_seconds": start_seconds(model),
        "extraction": extractions(model),
        **fidelity(document, load_mesh(source)),
    }


@click.command()
@models_options(RESULTS)
def main(models: Path, assets: Path, only: tuple[str, ...], output: Path) -> None:
    """Measure the decoder on every NAME.nisp in MODELS and print asked against measured."""
    peak, queries = matrix_peak(), paper_queries()
    plain = queries["plain"]
    plain["share_of_peak"] = round(plain["sdf_flops"] / peak, 3)
    for target in QUERIES:
        click.echo(target.line("8 x 64", plain))
    more = {"matrix_product_flops": round(peak), "paper": PAPER, "queries_8x64": queries}
    measure = partial(measured_asset, wide=plain)
    for name, record in measured(models, assets, only, output, measure, **more).items():
        for target in targets(name):
            click.echo(target.line(name, record))


if __name__ == "__main__":
    main()
