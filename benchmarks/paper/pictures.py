"""The paper's comparisons: UV by chart against UV without charts and against a network of colors.

    python -m benchmarks.paper.pictures --models DIR --assets ../shared/assets [--only spot]

DIR holds NAME.nisp for the assets NAME. Two networks are fitted to each asset, with the schedule of
the UV network of the model's preset: "unconditioned", from a point to its UV with no chart to tell;
and "color" (OverfitColor), from a point to the base color, of as many weights as the model's
chart and UV networks have together. Neither is quantized. Writes the JSON and, for each asset, one
picture, unlit: original, ours, unconditioned, color. Results are kept asset by asset; one that has
a result for the same bytes is not measured again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import click
import numpy as np

import nispcodec
from benchmarks.measuring.field_of import field_of
from benchmarks.measuring.likeness import mean_likeness
from benchmarks.measuring.model_records import measured, models_options
from benchmarks.measuring.result_file import Record
from benchmarks.measuring.target import Asked, Target
from nispcodec.core.arrays import Float32Array, Int64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.atomic_write import write_atomic
from nispcodec.core.network import Network, NetworkSpec
from nispcodec.core.progress import Progress
from nispcodec.core.sample_set import SampleSet
from nispcodec.dataset.recipes import TrainingSets, training_sets
from nispcodec.dataset.sampler import Sampler
from nispcodec.geometry.analysis import analyze
from nispcodec.infer.evaluate import evaluate
from nispcodec.io.load import load_mesh
from nispcodec.metrics.color import color_at
from nispcodec.metrics.parameterization import distortion_summary
from nispcodec.metrics.psnr import psnr
from nispcodec.metrics.sides import sides_of
from nispcodec.metrics.surface import Surface
from nispcodec.model import NispModel
from nispcodec.render.camera import Camera, turntable
from nispcodec.render.field import OPENING
from nispcodec.render.fragments import Scene
from nispcodec.render.images import image_bytes
from nispcodec.render.views import scene_of
from nispcodec.train.backend.choice import choose_engine
from nispcodec.train.config import TrainConfig
from nispcodec.train.objectives import UvObjective
from nispcodec.train.task import Schedule, Task
from nispcodec.train.tasks import paper_tasks
from nispcodec.train.workers import fit_networks

RESULTS = Path("benchmarks/results/paper_pictures.json")
PAINTERS = ("ours", "unconditioned", "color")
POINTS, VIEWS, SIZE = 100_000, 4, 320

TARGETS = [
    Target("color: dB above OverfitColor", ("gains", "color"), 0, at_least=True),
    Target("color: dB above no charts", ("gains", "unconditioned"), 0, at_least=True),
]

Painter = Callable[[Float32Array], Float32Array]
"""Points (n, 3), normalized frame -> base colors (n, 3), sRGB-encoded."""


def asked(results: Record) -> Iterator[Asked]:
    """The targets of every asset of several charts in a result file."""
    for name, record in results["assets"].items():
        if record["charts"] > 1:
            yield from (Asked(name, target, record) for target in TARGETS)


class PointObjective(UvObjective):
    """Mean absolute error of a network that sees the point alone; `uv` holds its targets."""

    def error(self, outputs: Float32Array, samples: SampleSet) -> float:
        """The loss."""
        return self.loss(outputs, samples)


def baselines(mesh: TexturedMesh, model: NispModel, seed: int, threads: int) -> dict[str, Network]:
    """The networks "unconditioned" and "color", fitted."""
    analysis = analyze(mesh, seed)
    sets = training_sets(Sampler(analysis, seed))
    surface = Surface.of(mesh, analysis.frame)
    tasks = [_unconditioned(model, sets), _color(model, sets, surface)]
    return fitted(tasks, seed, threads)


def unconditioned(mesh: TexturedMesh, model: NispModel, seed: int, threads: int) -> Network:
    """The network from a point to its UV with no chart to tell, fitted."""
    sets = training_sets(Sampler(analyze(mesh, seed), seed))
    return fitted([_unconditioned(model, sets)], seed, threads)["unconditioned"]


def fitted(tasks: list[Task], seed: int, threads: int) -> dict[str, Network]:
    """The networks of tasks; the native backend has no loss of three colors, torch has."""
    networks: dict[str, Network] = {}
    for name in ("auto", "torch"):
        alike = [task for task in tasks if (task.spec.outputs == UVS) == (name == "auto")]
        if alike:
            engine = choose_engine(name, "cpu", False, _told)
            networks |= fit_networks(alike, seed, engine, threads, _told)
    return networks


def _unconditioned(model: NispModel, sets: TrainingSets) -> Task:
    """As the model's UV network, but for charts."""
    spec = model.document.networks["uv"].spec
    plain = replace(spec, conditioning="none", charts=0, embedding=0)
    return _task("unconditioned", plain, sets.uvs, sets.held_out_surface, model, sets)


def _color(model: NispModel, sets: TrainingSets, surface: Surface) -> Task:
    """As many weights as the model's chart and UV networks have together."""
    spec = _of_size(sum(model.document.networks[name].spec.weight_count for name in _UV))
    samples, held_out = _colored(sets.uvs, surface), _colored(sets.held_out_surface, surface)
    return _task("color", spec, samples, held_out, model, sets)


def _task(
    name: str,
    spec: NetworkSpec,
    samples: SampleSet,
    held_out: SampleSet,
    model: NispModel,
    sets: TrainingSets,
) -> Task:
    objective = PointObjective(TrainConfig().loss)
    return Task(name, spec, samples, held_out, objective, _schedule(model, sets))


_UV = ("chart", "uv")
UVS = 2


def _schedule(model: NispModel, sets: TrainingSets) -> Schedule:
    """How the preset of the model fits its UV network, but for first frequencies and rounding."""
    preset = str(model.document.info.get("preset", "balanced"))
    if preset == "paper":
        tasks = paper_tasks(len(field_of(model.document).charts), sets, TrainConfig())
        return next(task.schedule for task in tasks if task.name == "uv")
    config = TrainConfig()
    learning = config.networks["uv"]
    steps = round(config.budgets[preset].steps * learning.step_share)
    rate, share = learning.learning_rate, learning.momentum_share
    return Schedule(steps, config.batch, rate, momentum_share=share)


def _of_size(weights: int) -> NetworkSpec:
    """Four layers, as wide as so many weights allow."""
    widths = range(1, 200)
    specs = (NetworkSpec(hidden=(width,) * 4, outputs=3) for width in widths)
    return [each for each in specs if each.weight_count <= weights][-1]


def _colored(samples: SampleSet, surface: Surface) -> SampleSet:
    return replace(samples, uv=_original_color(surface)(samples.points))


def _original_color(surface: Surface) -> Painter:
    def paint(points: Float32Array) -> Float32Array:
        closest = surface.closest(points.astype(np.float64))
        return color_at(surface, closest)[:, :3]

    return paint


def _told(progress: Progress) -> None:
    if progress.step % 500 == 0:
        click.echo(f"{progress.network} {progress.step}/{progress.steps}", err=True)


def without_charts(model: NispModel, uv: Network) -> NispModel:
    """The model with another UV network; charts still say which material a point has."""
    return NispModel(
        replace(model.document, field=replace(field_of(model.document), uv=uv), info={})
    )


@dataclass(frozen=True)
class Sight:
    """Where the model's surface is seen: pixels (n,) of a picture SIZE wide, points (n, 3)."""

    pixels: Int64Array
    points: Float32Array

    def painted(self, paint: Painter) -> Float32Array:
        """(SIZE, SIZE, 3): the colors of the points on white, unlit."""
        colors = np.ones((SIZE * SIZE, 3), np.float32)
        colors[self.pixels] = np.clip(paint(self.points), 0, 1)
        return colors.reshape(SIZE, SIZE, 3)


def sight(scene: Scene, camera: Camera) -> Sight:
    """What the camera sees of the scene, nothing through openings."""
    middle = (np.arange(SIZE) + 0.5) / SIZE
    x, y = np.meshgrid(middle, middle)
    directions = camera.directions(x.ravel(), y.ravel())
    origins = np.tile(camera.eye.astype(np.float32), (len(directions), 1))
    found = scene.cast(origins, directions, 0).fragments
    shown = np.array([material is not OPENING for material in scene.materials])[found.materials]
    rays, distances = found.rays[shown], found.distances[shown]
    return Sight(rays, origins[rays] + distances[:, None] * directions[rays])


def compared(
    mesh: TexturedMesh, model: NispModel, networks: dict[str, Network]
) -> tuple[Record, Float32Array]:
    """The numbers, and the picture of all four side by side."""
    surface = Surface.of(mesh, model.document.frame)
    free = without_charts(model, networks["unconditioned"])
    original = _original_color(surface)
    painters: dict[str, Painter] = {
        "ours": lambda points: model.color(points, "normalized")[:, :3],
        "unconditioned": lambda points: free.color(points, "normalized")[:, :3],
        "color": lambda points: evaluate(networks["color"], points),
    }
    points = surface.sample(POINTS, np.random.default_rng(1))
    points = points[sides_of(surface, points).outer]
    places, wanted = points.positions.astype(np.float32), color_at(surface, points)[:, :3]
    scene = scene_of(model)
    sights = [sight(scene, camera) for camera in turntable(VIEWS)]
    truth = [each.painted(original) for each in sights]
    numbers: Record = {}
    columns = [truth[0]]
    for name, paint in painters.items():
        off = np.clip(paint(places), 0, 1).astype(np.float64) - wanted
        drawn = [each.painted(paint) for each in sights]
        columns.append(drawn[0])
        alike = {f"picture_{key}": each for key, each in mean_likeness(truth, drawn).items()}
        numbers[name] = {"color_psnr": psnr(float((off**2).mean()), 1.0), **alike}
    distortion = {
        "original": distortion_summary(surface),
        "ours": distortion_summary(_decoded(model)),
        "unconditioned": distortion_summary(_decoded(free)),
    }
    return {**numbers, "distortion": distortion}, np.concatenate(columns, axis=1)


def _decoded(model: NispModel) -> Surface:
    return Surface.of(model.to_mesh(), model.document.frame)


def measure(path: Path, source: Path, seed: int, threads: int) -> tuple[Record, Float32Array]:
    """Everything about one asset, and the picture."""
    mesh, model = load_mesh(source), nispcodec.load(path)
    if not set(_UV) <= set(model.document.networks):
        raise click.UsageError(f"{path}: expected charts and UVs")
    networks = baselines(mesh, model, seed, threads)
    numbers, drawn = compared(mesh, model, networks)
    ours = numbers["ours"]["color_psnr"]
    record = {
        "charts": len(field_of(model.document).charts),
        "weights": {name: each.spec.weight_count for name, each in networks.items()},
        "gains": {name: ours - numbers[name]["color_psnr"] for name in networks},
        **numbers,
    }
    return record, drawn


@click.command()
@models_options(RESULTS)
@click.option("--seed", type=click.IntRange(0), default=0, show_default=True)
@click.option("--threads", type=click.IntRange(1), default=2, show_default=True)
def main(
    models: Path, assets: Path, only: tuple[str, ...], seed: int, threads: int, output: Path
) -> None:
    """Compare every NAME.nisp in MODELS and print asked against measured."""
    output.parent.mkdir(parents=True, exist_ok=True)

    def measure_and_draw(path: Path, source: Path) -> Record:
        record, drawn = measure(path, source, seed, threads)
        picture = output.with_name(f"{output.stem}_{path.stem}.webp")
        write_atomic(picture, image_bytes([drawn], ".webp"))
        return record

    for name, record in measured(models, assets, only, output, measure_and_draw).items():
        click.echo(_told_of(name, record))


def _told_of(name: str, record: Record) -> str:
    """An asset's lines of the table."""
    lines = []
    for painter in PAINTERS:
        psnr, color = record[painter]["picture_psnr"], record[painter]["color_psnr"]
        lines.append(f"{name:<18}{painter:<16}color {color:.2f} dB, pictures {psnr:.2f} dB")
    for kind, each in record["distortion"].items():
        values = ", ".join(f"{key} {value:.4g}" for key, value in each.items())
        lines.append(f"{name:<18}{kind:<16}distortion {values}")
    questions = asked({"assets": {name: record}})
    return "\n".join([*lines, *(each.line() for each in questions)])


if __name__ == "__main__":
    main()
