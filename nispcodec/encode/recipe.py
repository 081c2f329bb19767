"""The encoder: a textured mesh and a preset in, a model out."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from nispcodec.core.asset import Material, Texture, TexturedMesh
from nispcodec.core.document import ChartTable, Document, Frame
from nispcodec.core.errors import NispError
from nispcodec.core.network import Network
from nispcodec.core.progress import Listener, Progress, silent

if TYPE_CHECKING:
    from nispcodec.dataset.recipes import TrainingSets
    from nispcodec.dataset.sampler import Sampler
    from nispcodec.model import NispModel
    from nispcodec.train.prune import Pruning
    from nispcodec.train.task import Task

PRESETS = ("balanced", "paper", "fast", "best")
GAP = 0.1
"""Charts some times further apart than this (normalized frame) share numbers; not in `paper`."""

UNSEEN = 1e-7
"""A share of the radius that nobody sees: a thousandth of what evaluators may differ by."""

NOTABLE_SHEETS = 0.02
"""From this share of the area on, sheets are worth the finer extraction that they need."""


@dataclass(frozen=True)
class EncodeConfig:
    """How to encode.

    preset          one of `PRESETS`
    seed            of everything random: the same input, seed and threads give the same bytes
    device          "auto", "cpu", "cuda"
    threads         cores to use; 0: all
    pad_textures    fills what no face uses of an image with the colors beside it
    texture_format  None keeps the image files as they are; "webp", "avif", "jpeg" re-encode them
    texture_quality 1 to 100, for a `texture_format` and for images that are padded
    textures        False leaves the images out
    target_size     bytes of the file without its textures; the networks are made to fit
    target_error    mean distance to the surface (normalized frame); the SDF is made to fit
    prune           None, "smallest", "smallest_global" or "large_final": lottery tickets
    prune_rate      share of weights to prune, 0 to below 1; or by network: {"sdf": 0.3, "uv": 0.5}
    prune_rounds    in which the rate is reached: each takes as long as an encode
    """

    preset: str = "balanced"
    seed: int = 0
    device: str = "auto"
    threads: int = 0
    pad_textures: bool = False
    texture_format: str | None = None
    texture_quality: int = 90
    textures: bool = True
    target_size: float | None = None
    target_error: float | None = None
    prune: str | None = None
    prune_rate: float | Mapping[str, float] = 0.5
    prune_rounds: int = 2

    def __post_init__(self) -> None:
        if self.preset not in PRESETS:
            raise NispError(f"preset: expected one of {', '.join(PRESETS)}, found {self.preset!r}")
        if self.seed < 0 or self.threads < 0:
            raise NispError("seed and threads: expected 0 or more")
        targets = [each for each in (self.target_size, self.target_error) if each is not None]
        if len(targets) > 1 or (targets and self.preset == "paper"):
            raise NispError("target size, target error, preset paper: expected one of them")
        if any(not 0 < each < math.inf for each in targets):
            raise NispError(f"target size or error: expected more than 0, found {targets[0]:g}")
        self.prunings()

    def prunings(self) -> dict[str, Pruning]:
        """The pruning of every network that is to be pruned, by its name."""
        from nispcodec.train.prune import prunings

        return prunings(self.prune, self.prune_rate, self.prune_rounds) if self.prune else {}


def encode(
    mesh: TexturedMesh, config: EncodeConfig | None = None, progress: Listener = silent
) -> NispModel:
    """Fit networks to an asset. Ctrl-C and errors leave nothing behind.

    Each network has a process of its own. Outside of Linux, and with CUDA, these start afresh: a
    script then wants `if __name__ == "__main__":` around its calls.

    Raises MeshError when nothing of the mesh can be held by a signed distance, FitError when a
    network does not converge.
    """
    from nispcodec.model import NispModel

    config = config or EncodeConfig()
    materials, textures = _appearance(mesh, config, progress)
    sampler, sets = _sample(mesh, config, progress)

    def document(networks: Mapping[str, Network]) -> Document:
        return Document(
            frame=_short_frame(sampler.frame),
            charts=_short_map(sampler.table),
            materials=materials,
            textures=textures,
            sdf=networks["sdf"],
            chart=networks.get("chart"),
            uv=networks.get("uv"),
            half_thickness=_shell(sampler),
        )

    done = document(_fit(sampler, sets, config, document, progress))
    return NispModel(replace(done, info=_measured(done, sampler, sets, config)))


def _appearance(
    mesh: TexturedMesh, config: EncodeConfig, progress: Listener
) -> tuple[tuple[Material, ...], tuple[Texture, ...]]:
    from nispcodec.core.texture import reencode
    from nispcodec.edit.texture_padding import with_padded_gutters

    if not config.textures:
        return tuple(replace(material, maps={}) for material in mesh.materials), ()
    progress(Progress(stage="textures"))
    textures, quality = mesh.textures, config.texture_quality
    if config.pad_textures:
        textures = with_padded_gutters(mesh, 100 if config.texture_format else quality)
    if config.texture_format is not None:
        textures = reencode(textures, config.texture_format, quality)
    return mesh.materials, textures


def _sample(
    mesh: TexturedMesh, config: EncodeConfig, progress: Listener
) -> tuple[Sampler, TrainingSets]:
    from nispcodec.dataset.recipes import paper_training_sets, training_sets
    from nispcodec.dataset.sampler import Sampler

    progress(Progress(stage="charts and hidden walls"))
    paper = config.preset == "paper"
    sampler = Sampler(mesh, config.seed, gap=0.0 if paper else GAP)
    progress(Progress(stage="samples"))
    return sampler, (paper_training_sets if paper else training_sets)(sampler)


def _fit(
    sampler: Sampler,
    sets: TrainingSets,
    config: EncodeConfig,
    document: Callable[[Mapping[str, Network]], Document],
    progress: Listener,
) -> Mapping[str, Network]:
    """The networks: the published ones, or sine networks as large as the target asks."""
    progress(Progress(stage="fit"))
    from nispcodec.encode.targets import Fitting, fit_to_error, fit_to_size, fit_with_preset, pruned
    from nispcodec.train.presets import EFFORTS, Problem, paper_tasks
    from nispcodec.train.workers import fit_networks, resolve_device

    device, threads = resolve_device(config.device), config.threads or os.cpu_count() or 1

    def fit(tasks: list[Task], listen: Listener) -> dict[str, Network]:
        return fit_networks(tasks, config.seed, device, threads, listen)

    problem = Problem.of(sampler, sets)
    if config.preset == "paper":
        tasks = paper_tasks(problem.charts, sets)
        needed = [task for task in tasks if task.name in problem.networks]
        return fit(pruned(needed, config.prunings()), progress)
    fitting = Fitting(problem, EFFORTS[config.preset], fit, progress, config.prunings())
    if config.target_error is not None:
        return fit_to_error(fitting, config.target_error)
    if config.target_size is not None:
        return fit_to_size(fitting, config.target_size, document)
    return fit_with_preset(fitting)


def _short_frame(frame: Frame) -> Frame:
    """Float32 where that moves no point by more than `UNSEEN` of the radius: half the bytes."""
    x, y, z, radius = _single([*frame.center, frame.radius], UNSEEN * frame.radius)
    return Frame((x, y, z), radius)


def _short_map(table: ChartTable) -> ChartTable:
    """The map to the asset's UV, as `_short_frame`."""
    limit = UNSEEN * min(table.uv_scale)
    u, v = _single(table.uv_offset, limit)
    scale_u, scale_v = _single(table.uv_scale, limit)
    return replace(table, uv_offset=(u, v), uv_scale=(scale_u, scale_v))


def _single(values: Sequence[float], limit: float) -> list[float]:
    singles = [float(np.float32(value)) for value in values]
    pairs = zip(values, singles, strict=True)
    return [single if abs(single - value) <= limit else value for value, single in pairs]


def _shell(sampler: Sampler) -> float:
    from nispcodec.geometry.solid import SHELL

    return SHELL if sampler.solid.open_surface_share >= NOTABLE_SHEETS else 0.0


def _measured(
    document: Document, sampler: Sampler, sets: TrainingSets, config: EncodeConfig
) -> dict[str, str | int | float | bool]:
    """Held-out errors of the networks as stored, by the decoder's own evaluation."""
    from nispcodec.model import NispModel

    model = NispModel(document)
    near, skin = sets.held_distance, sets.held_skin
    distance = np.abs(model.sdf(near.points, frame="normalized") - near.sdf)
    measured: dict[str, str | int | float | bool] = {
        "preset": config.preset,
        "seed": config.seed,
        "hidden_share": _short(sampler.solid.hidden_share),
        "open_surface_share": _short(sampler.solid.open_surface_share),
        "distance_error": _short(distance.mean()),
    }
    charts = model.charts(skin.points, frame="normalized")
    if document.chart is not None:
        measured["chart_accuracy"] = _short((charts == skin.chart).mean())
    if document.uv is not None:
        wanted = skin.uv * document.charts.uv_scale + document.charts.uv_offset
        off = np.linalg.norm(model.uv(skin.points, "normalized", charts) - wanted, axis=1)
        measured["uv_error_median"] = _short(np.median(off))
        measured["uv_error_mean"] = _short(off.mean())
    return measured


def _short(value: float | np.floating) -> float:
    """Three significant digits: all that such a measurement is good for."""
    return float(f"{float(value):.3g}")
