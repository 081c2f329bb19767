"""The encoder's recipe: a textured mesh in, a model out, one line a stage."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial

from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import Document, Field
from nispcodec.core.errors import TargetSizeError
from nispcodec.core.memory import freeing
from nispcodec.core.mesh_part import MeshPart
from nispcodec.core.progress import Listener, Progress, silent
from nispcodec.core.sample_set import SampleSet
from nispcodec.encode.appearance import appearance
from nispcodec.encode.choice import Choice, Chosen, Loss, Made
from nispcodec.encode.config import EncodeConfig, Tuning
from nispcodec.encode.faults import fault_warnings
from nispcodec.encode.field_form import FieldForm
from nispcodec.encode.mesh_form import MeshForm
from nispcodec.encode.report import measured, unmeasured
from nispcodec.encode.single_precision import short_frame
from nispcodec.encode.split import split
from nispcodec.encode.stages import with_overall
from nispcodec.encode.total import encode_to_total
from nispcodec.geometry.analysis import analyze
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

    def encoded(how: EncodeConfig, listen: Listener, loss: Loss | None = None) -> NispModel:
        return _encoded(mesh, how, listen, numbers, loss)

    with on_cores(config.threads):
        if config.target_total is not None:
            return encode_to_total(mesh, config, numbers.total, encoded, progress)
        return encoded(config, progress)


def _encoded(
    mesh: TexturedMesh,
    config: EncodeConfig,
    progress: Listener,
    tuning: Tuning,
    loss: Loss | None = None,
) -> NispModel:
    progress = freeing(with_overall(progress, config, tuning.training))
    engine = choose_engine(config.engine, config.device, config.preset == "paper", progress)
    materials, textures = appearance(mesh, config, tuning.compact, progress)
    progress(Progress(stage="charts and hidden walls"))
    analysis = analyze(mesh, config.seed, tuning.geometry_of(config.preset))
    for warning in analysis.solid.warnings:
        progress(Progress(stage="charts and hidden walls", warning=f"{mesh.name}: {warning}"))
    frame = short_frame(analysis.frame, tuning.negligible)
    form = MeshForm(analysis, config.seed, tuning.forms_of(config.preset), progress)
    field = FieldForm(analysis, config, tuning, engine, progress)

    def document(held: Field | None = None, parts: tuple[MeshPart, ...] = ()) -> Document:
        info = unmeasured(config, held is not None)
        return Document(frame, materials, textures, held, parts, info)

    def written(chosen: Chosen) -> Document:
        return replace(chosen.document, info=measured(chosen, analysis, config))

    halves, trial = partial(split, field), field.trial
    choice = Choice(form, config, tuning, halves, trial, document, written, loss)
    if config.geometry == "mesh" or choice.settled:
        chosen = choice.triangles()
        info = measured(chosen, analysis, config)
        return _finished(chosen, info, form, mesh.name, config, tuning, progress)
    fitted, surface = _networks(field, document, choice)
    chosen = choice.after_fit(fitted, form.errors(fitted)) if fitted else choice.triangles()
    info = measured(chosen, analysis, config, engine.name, surface)
    return _finished(chosen, info, form, mesh.name, config, tuning, progress)


def _networks(
    field: FieldForm, document: Made, choice: Choice
) -> tuple[Document | None, SampleSet]:
    """A document of networks, or of some bodies as each; None where triangles are to be taken.

    And what charts are judged by. All else that networks learn from, and both halves, are freed.
    """
    held = _fitted(field, document, choice)
    halves, choice.split = choice.split, None
    if halves:
        field.forget()
        field = halves.field
        held = field.fit(lambda found: document(found, ()))
    surface = field.sets.held_out_surface
    field.forget()
    parts = halves.parts(document(held, ())) if halves else ()
    return document(held, parts) if held else None, surface


def _fitted(field: FieldForm, document: Made, choice: Choice) -> Field | None:
    """The networks; None where triangles are to be taken, alone or beside other networks."""
    try:
        return field.fit(lambda held: document(held, ()), choice.wants_field)
    except TargetSizeError as refused:
        choice.without_networks(refused)
        return None


def _finished(
    chosen: Chosen,
    info: Mapping[str, str | int | float | bool],
    form: MeshForm,
    name: str,
    config: EncodeConfig,
    tuning: Tuning,
    progress: Listener,
) -> NispModel:
    """The model, after its owner was told what its parts are off, and warned of their faults."""
    notable = tuning.forms.notable_far
    better = tuning.training.better_than(config.preset)
    discolored = form.discolored(chosen.document)
    for warning in fault_warnings(chosen.document, chosen.errors, discolored, better, notable):
        progress(Progress(stage="surface", warning=f"{name}: {warning}"))
    errors = form.part_errors(chosen.document)
    progress(Progress(stage="surface", step=2, steps=2, part_errors=errors))
    return NispModel(replace(chosen.document, info=info))
