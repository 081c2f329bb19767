"""The native backend: whole runs of steps in one call of compiled code."""

from __future__ import annotations

from nispcodec.core.arrays import Float32Array
from nispcodec.core.errors import FitError
from nispcodec.train.backend.native.library import library
from nispcodec.train.backend.native.nearest_grid import NearestGrid
from nispcodec.train.backend.native.settings import Settings
from nispcodec.train.backend.native.trainer import NativeTrainer, why_not
from nispcodec.train.backend.protocol import ErrorRadii
from nispcodec.train.task import Task


class NativeEngine:
    """See `nispcodec.train.backend.protocol.Engine`. Raises NativeError where there is none."""

    name = "native"

    def __init__(self) -> None:
        library()

    def trainer(
        self, task: Task, weights: Float32Array, kept: Float32Array | None
    ) -> NativeTrainer:
        """See `Engine`. Raises FitError for a network that only torch can train."""
        loss, schedule = task.objective.loss_name, task.schedule
        if why := why_not(task.spec, loss, schedule.optimizer):
            raise FitError(f"{task.name} network: {why}")
        settings = Settings.of(
            task.config, schedule.momentum_share, schedule.last_layer_lr_scale, task.mean_weight
        )
        return NativeTrainer(task.spec, task.samples, loss, weights, kept, settings)

    def error_radii(self, task: Task) -> ErrorRadii:
        """See `Engine`."""
        grid, sdf = NearestGrid(task.samples.points), task.samples.sdf

        def found(field: Float32Array, limit: float, floaters: bool) -> Float32Array:
            return grid.error_radii(sdf, field, limit, floaters)

        return found
