"""The encoder's recipe: a textured mesh in, a model out, one line a stage."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import Document, Field
from nispcodec.core.mesh_part import MeshPart
from nispcodec.core.network import Network
from nispcodec.core.progress import Listener, Progress, silent
from nispcodec.dataset.recipes import paper_training_sets, training_sets
from nispcodec.dataset.sampler import Sampler
from nispcodec.encode.appearance import appearance
from nispcodec.encode.choice import Choice, Chosen
from nispcodec.encode.config import EncodeConfig, Tuning
from nispcodec.encode.far_surface import far_warnings
from nispcodec.encode.fitting import fit
from nispcodec.encode.mesh_form import MeshForm
from nispcodec.encode.report import measured
from nispcodec.encode.single_precision import short_frame, short_uv_map
from nispcodec.encode.stages import with_overall
from nispcodec.encode.total import encode_to_total
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
    config, numbers = config or EncodeConfig(), tuning or Tuning()

    def encoded(how: EncodeConfig, listen: Listener) -> NispModel:
        return _encoded(mesh, how, listen, numbers)

    with on_cores(config.threads):
        if config.target_total is not None:
            return encode_to_total(mesh, config, numbers.total, encoded, progress)
        return encoded(config, progress)


def _encoded(
    mesh: TexturedMesh, config: EncodeConfig, progress: Listener, tuning: Tuning
) -> NispModel:
    progress = with_overall(progress, config, tuning.training)
    published = config.preset == "paper"
    engine = choose_engine(config.engine, config.device, published, progress)
    materials, textures = appearance(mesh, config, tuning.compact, progress)
    progress(Progress(stage="charts and hidden walls"))
    analysis = analyze(mesh, config.seed, tuning.geometry_of(config.preset))
    for warning in analysis.solid.warnings:
        progress(Progress(stage="charts and hidden walls", warning=f"{mesh.name}: {warning}"))
    frame = short_frame(analysis.frame, tuning.negligible)
    form = MeshForm(analysis, config.seed, tuning.forms, progress)
    choice = Choice(form, config, tuning)

    def of_networks(networks: Mapping[str, Network]) -> Document:
        return Document(frame, materials, textures, _field(networks, analysis, tuning))

    def of_triangles(parts: tuple[MeshPart, ...]) -> Document:
        return Document(frame, materials, textures, meshes=parts)

    if config.geometry == "mesh":
        chosen = choice.triangles(of_triangles)
        info = measured(chosen, analysis, config)
        return _finished(chosen, info, mesh.name, config, tuning, progress)
    progress(Progress(stage="samples"))
    sampler = Sampler(analysis, config.seed, tuning.sampling_of(config.preset))
    sets = (paper_training_sets if published else training_sets)(sampler)
    progress(Progress(stage="fit"))
    networks = fit(
        analysis, sets, config, tuning.training, engine, of_networks, choice.wants_field, progress
    )
    if networks:
        fitted = of_networks(networks)
        chosen = choice.after_fit(fitted, form.errors(fitted))
    else:
        chosen = choice.triangles(of_triangles)
    info = measured(chosen, analysis, config, engine.name, sets)
    return _finished(chosen, info, mesh.name, config, tuning, progress)


def _finished(
    chosen: Chosen,
    info: Mapping[str, str | int | float | bool],
    name: str,
    config: EncodeConfig,
    tuning: Tuning,
    progress: Listener,
) -> NispModel:
    """The model, after its owner was warned of surface that is made up or lost."""
    notable = tuning.forms.notable_far
    better = tuning.training.better_than(config.preset)
    for warning in far_warnings(chosen.document, chosen.errors, better, notable):
        progress(Progress(stage="surface", warning=f"{name}: {warning}"))
    return NispModel(replace(chosen.document, info=info))


def _field(networks: Mapping[str, Network], analysis: Analysis, tuning: Tuning) -> Field:
    notable = analysis.solid.open_surface_share >= tuning.notable_open
    return Field(
        charts=short_uv_map(analysis.table, tuning.negligible),
        sdf=networks["sdf"],
        chart=networks.get("chart"),
        uv=networks.get("uv"),
        half_thickness=analysis.solid.half_thickness if notable else 0.0,
    )
