"""An asset, or some of its bodies, held as networks: samples, what probes say, and the fit."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

from nispcodec.core.cores import cores
from nispcodec.core.document import Document, Field
from nispcodec.core.network import Network
from nispcodec.core.progress import Listener, Progress
from nispcodec.dataset.recipes import TrainingSets, paper_training_sets, training_sets
from nispcodec.dataset.sampler import Sampler
from nispcodec.encode.config import EncodeConfig, Tuning
from nispcodec.encode.single_precision import short_uv_map
from nispcodec.encode.targets import (
    FitContext,
    fit_to_error,
    fit_to_size,
    fit_with_preset,
    pruned,
)
from nispcodec.geometry.analysis import Analysis
from nispcodec.geometry.triangles import area
from nispcodec.train.backend.protocol import Engine
from nispcodec.train.task import Task
from nispcodec.train.tasks import AssetProblem, paper_tasks
from nispcodec.train.workers import fit_networks


@dataclass(frozen=True)
class FieldForm:
    """The bodies of an analysis as networks; samples are drawn, and probes fitted, once."""

    analysis: Analysis
    config: EncodeConfig
    tuning: Tuning
    engine: Engine
    progress: Listener

    @cached_property
    def sets(self) -> TrainingSets:
        """The samples that networks learn from.

        Raises MeshError for a texture that does not decode.
        """
        self.progress(Progress(stage="samples"))
        preset = self.config.preset
        sampler = Sampler(self.analysis, self.config.seed, self.tuning.sampling_of(preset))
        found = (paper_training_sets if preset == "paper" else training_sets)(sampler)
        self.analysis.field.forget()
        return found

    def forget(self) -> None:
        """Free the samples and what was made of them."""
        for name in ("sets", "_problem", "_context"):
            vars(self).pop(name, None)

    @property
    def foreseen(self) -> tuple[float, float]:
        """Bytes of a preset's networks, about, and the held-out error of the SDF's probe.

        The error is a distance in the normalized frame.
        """
        return self._context.foreseen

    def trial(self) -> Field:
        """The preset's networks after a few steps, to be looked at before they are fitted."""
        return self._field(self._context.trial())

    def fit(
        self,
        document: Callable[[Field], Document],
        wanted: Callable[[float, float], bool] = lambda size, probe_error: True,
    ) -> Field | None:
        """The networks: published ones, or sine networks as large as the preset or target asks.

        None where a preset's, whose bytes and probe error are told to `wanted`, are not.
        Raises FitError when a network does not converge, TargetSizeError for too small a size.
        """
        problem, config = self._problem, self.config
        self.progress(Progress(stage="fit"))
        if config.preset == "paper":
            tasks = paper_tasks(problem.charts, self.sets, self.tuning.training)
            needed = [task for task in tasks if task.name in problem.networks]
            return self._field(self._run(pruned(needed, config.prunings()), self.progress))
        if config.target_error is not None:
            return self._field(fit_to_error(self._context, config.target_error))
        if config.target_size is not None:
            networks = fit_to_size(
                self._context,
                config.target_size,
                lambda found: document(self._field(found)),
                wanted,
            )
            return self._field(networks) if networks else None
        networks = fit_with_preset(self._context, wanted)
        return self._field(networks) if networks else None

    def _run(self, tasks: list[Task], listen: Listener) -> dict[str, Network]:
        return fit_networks(tasks, self.config.seed, self.engine, cores(), listen)

    @cached_property
    def _problem(self) -> AssetProblem:
        """Everything about the asset that the tasks of its networks depend on."""
        table, symmetry = self.analysis.table, self.analysis.symmetry
        return AssetProblem(
            self.sets,
            charts=len(table),
            has_uv=bool(table.has_uv.any()),
            area=float(area(self.analysis.solid.pieces).sum()),
            sdf_mirror=symmetry.sdf,
            uv_mirror=symmetry.uv,
            config=self.tuning.training,
        )

    @cached_property
    def _context(self) -> FitContext:
        budget = self.tuning.training.budgets[self.config.preset]
        prunings = self.config.prunings()
        return FitContext(self._problem, budget, self._run, self.progress, prunings)

    def _field(self, networks: Mapping[str, Network]) -> Field:
        solid = self.analysis.solid
        notable = solid.open_surface_share >= self.tuning.notable_open
        return Field(
            charts=short_uv_map(self.analysis.table, self.tuning.negligible),
            sdf=networks["sdf"],
            chart=networks.get("chart"),
            uv=networks.get("uv"),
            half_thickness=solid.half_thickness if notable else 0.0,
        )
