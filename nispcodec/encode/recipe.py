"""The encoder's recipe: a textured mesh in, a model out, one line a stage."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import Document
from nispcodec.core.network import Network
from nispcodec.core.progress import Listener, Progress, silent
from nispcodec.dataset.recipes import paper_training_sets, training_sets
from nispcodec.dataset.sampler import Sampler
from nispcodec.encode.appearance import appearance
from nispcodec.encode.config import EncodeConfig, Tuning
from nispcodec.encode.fitting import fit
from nispcodec.encode.report import measured
from nispcodec.encode.single_precision import short_frame, short_uv_map
from nispcodec.encode.stages import with_overall
from nispcodec.geometry.analysis import Analysis, analyze
from nispcodec.infer.parallel import on_cores
from nispcodec.model import NispModel
from nispcodec.train.backend.choice import choose_engine


def encode(
    mesh: TexturedMesh,
    config: EncodeConfig | None = None,
    progress: Listener = silent,
    tuning: Tuning | None = None,
) -> NispModel:
    """Fit networks to an asset. Ctrl-C and errors leave nothing behind.

    Raises MeshError when nothing of the mesh can be held by a signed distance, FitError when a
    network does not converge, and, before the work, for a device or an engine that is not there,
    NispError for a target that cannot be met and for a package that is missing.
    """
    config = config or EncodeConfig()
    with on_cores(config.threads):
        return _encoded(mesh, config, progress, tuning or Tuning())


def _encoded(
    mesh: TexturedMesh, config: EncodeConfig, progress: Listener, tuning: Tuning
) -> NispModel:
    progress = with_overall(progress, config, tuning.training)
    published = config.preset == "paper"
    engine = choose_engine(config.engine, config.device, published, progress)
    materials, textures = appearance(mesh, config, progress)
    progress(Progress(stage="charts and hidden walls"))
    analysis = analyze(mesh, config.seed, tuning.geometry_of(config.preset))
    for warning in analysis.solid.warnings:
        progress(Progress(stage="charts and hidden walls", warning=f"{mesh.name}: {warning}"))
    progress(Progress(stage="samples"))
    sampler = Sampler(analysis, config.seed, tuning.sampling)
    sets = (paper_training_sets if published else training_sets)(sampler)

    def document(networks: Mapping[str, Network]) -> Document:
        return Document(
            frame=short_frame(analysis.frame, tuning.negligible),
            charts=short_uv_map(analysis.table, tuning.negligible),
            materials=materials,
            textures=textures,
            sdf=networks["sdf"],
            chart=networks.get("chart"),
            uv=networks.get("uv"),
            half_thickness=_half_thickness(analysis, tuning),
        )

    progress(Progress(stage="fit"))
    done = document(fit(analysis, sets, config, tuning.training, engine, document, progress))
    return NispModel(replace(done, info=measured(done, analysis, sets, config, engine.name)))


def _half_thickness(analysis: Analysis, tuning: Tuning) -> float:
    notable = analysis.solid.open_surface_share >= tuning.notable_open
    return analysis.solid.half_thickness if notable else 0.0
