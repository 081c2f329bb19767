"""The training loop: one network, one task, the best weights by held-out error."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from contextlib import AbstractContextManager
from dataclasses import replace

import torch
from torch import Tensor

from nispcodec.core.errors import FitError
from nispcodec.core.network import MAX_INIT_SEED, Network
from nispcodec.core.progress import Listener, Progress
from nispcodec.dataset.hard_examples import error_radii
from nispcodec.train.backend.torch.module import Module
from nispcodec.train.backend.torch.optimizer import optimizer
from nispcodec.train.batch import Batch
from nispcodec.train.config import LoopConfig
from nispcodec.train.prune import Mask
from nispcodec.train.quantize import round_weights
from nispcodec.train.task import Quantization, Schedule, Task

TINY = 1e-12


def train(
    task: Task,
    seed: int,
    device: str,
    core: AbstractContextManager[object],
    listen: Listener,
    mask: Mask | None = None,
) -> Network:
    """Fit one network; `core` is held while computing, so that tasks share the cores fairly.

    What a `mask` prunes is 0 from the first step to the last; initial weights depend on the seed.
    After hard examples were mined, every other sample of a batch is one of these
    (`nispcodec.dataset.hard_examples`).

    A run whose held-out error explodes goes on from its best weights at half the rate. At
    the end the weights are rounded (`nispcodec.train.quantize`), if the task says how.
    Raises FitError when lower rates do not help.
    """
    run = _Run(task, seed, device, listen)
    if mask is not None:
        run.module.prune(mask)
    return run.fit(core)


class _Run:
    def __init__(self, task: Task, seed: int, device: str, listen: Listener) -> None:
        self.task = task
        self.listen = listen
        self.generator = torch.Generator().manual_seed(seed)
        spec = replace(task.spec, init_seed=seed % (MAX_INIT_SEED + 1))
        self.config = task.config
        self.module = Module(spec, device, task.schedule.w0_scale)
        self.held_out = Batch.of(task.held_out, device)
        self.samples = Batch.of(task.samples, device)
        if task.spec.conditioning == "chart_affine":
            self.module.place_chart_affine(
                self.samples.points, self.samples.chart, self.samples.uv, self.config.affine_ridge
            )
        self.hardness = torch.zeros(len(self.samples))
        self.batches = self._batches()
        self.minings = _minings(task.schedule)
        self.rate = task.schedule.rate
        self.retries = 0
        self.optimizer_step = optimizer(self.module, task.schedule, self.config)
        self.ema_weight = _ema_weight(task.schedule, self.config.loop)
        self.mean = self._weights()
        self.best_error = math.inf
        self.best = self._weights()
        self.loss = math.nan

    def fit(self, core: AbstractContextManager[object]) -> Network:
        steps = self.task.schedule.steps
        every, chunk = max(1, steps // self.config.loop.checks), self.config.loop.chunk
        started = time.monotonic()
        for step in range(0, steps, chunk):
            with core:
                for inner in range(step, min(step + chunk, steps)):
                    self._step(inner)
                done = min(step + chunk, steps)
                note = self._check(done) if done // every > step // every or done == steps else ""
            left = (time.monotonic() - started) / done * (steps - done)
            self.listen(
                Progress(self.task.name, "fit", done, steps, self.loss, self.error, left, note)
            )
        self._set(self.best)
        if self.task.quantization is not None:
            with core:
                self._quantize(self.task.quantization)
        return self.module.network()

    error = math.nan

    def _step(self, step: int) -> None:
        schedule = self.task.schedule
        if step in self.minings:
            self._mine_hard_examples(floaters=step > self.minings[0])
        loss = self.task.objective.loss(self.module, next(self.batches))
        self.module.weights.grad = None
        loss.backward()  # type: ignore[no-untyped-call]
        self._remember(float(loss.detach()))
        self._clip()
        self.optimizer_step(self.rate * _rate_shape(schedule, step, self.config.loop))
        self.module.apply_mask()
        self.mean.lerp_(self.module.weights.detach(), self.ema_weight)

    def _quantize(self, quantization: Quantization) -> None:
        """Round the best weights, again with other samples where that costs much."""
        steps, before, config = self.task.schedule.steps, self.best_error, self.config.quantize
        told = Progress(self.task.name, "quantize", steps, steps, self.loss, before, 0.0)
        tries: list[tuple[float, Tensor, Tensor | None]] = []
        rise = config.slight if len(self.best) < config.large else config.notable
        absolute, objective = self._absolute(quantization), self.task.objective
        while len(tries) < config.tries and all(error > before * rise for error, *_ in tries):
            self.listen(told)
            self._set(self.best)
            round_weights(self.module, self.samples, absolute, objective, self.generator, config)
            tries.append((self._error(), self._weights(), self.module.steps))
        after, self.best, self.module.steps = min(tries, key=lambda each: each[0])
        self._set(self.best)
        note = f"held-out error {before:.3g} before, {after:.3g} after"
        self.listen(replace(told, error=after, note=note))

    @torch.no_grad()
    def _absolute(self, quantization: Quantization) -> Quantization:
        """With a lambda that is a rise of the loss, and no share of what the fit is left with."""
        if not self.task.objective.own_curvature:
            return quantization
        left = float(self.task.objective.loss(self.module, self.held_out))
        return replace(quantization, lambda_=left * quantization.lambda_)

    @torch.no_grad()
    def _mine_hard_examples(self, floaters: bool) -> None:
        """From now on take samples on the wrong side more often, most those that cost most."""
        samples, config = self.samples, self.config.hard_examples
        parts = torch.split(samples.points, config.batch)
        field = torch.cat([self.module(part)[:, 0] for part in parts])
        points, sdf, found = (part.cpu().numpy() for part in (samples.points, samples.sdf, field))
        radii = torch.from_numpy(error_radii(points, sdf, found, config.error_radius, floaters))
        self.hardness = torch.maximum(config.memory * self.hardness, radii)
        self.batches = self._batches()

    def _batches(self) -> Iterator[Batch]:
        """Rounds of all samples in random order; a batch never straddles two rounds.

        Where there are hard examples, every other sample is one of these, by its hardness.
        """
        count, generator = len(self.samples), self.generator
        size = min(self.task.schedule.batch, count)
        hard = self.hardness.nonzero()[:, 0]
        while True:
            order = torch.randperm(count, generator=generator)
            if len(hard):
                weight = self.hardness[hard]
                again = torch.multinomial(weight, count, True, generator=generator)
                order = torch.stack([order, hard[again]], dim=1).flatten()
            yield from self.samples.chosen(order.to(self.samples.points.device)).parts(size)

    def _clip(self) -> None:
        gradient = self.module.weights.grad
        assert gradient is not None
        gradient.mul_((self.config.loop.clip / (gradient.norm() + TINY)).clamp_(max=1.0))

    def _remember(self, loss: float) -> None:
        memory = self.config.loop.loss_memory if math.isfinite(self.loss) else 0.0
        self.loss = memory * self.loss + (1 - memory) * loss if memory else loss

    def _check(self, done: int) -> str:
        """Measure the held-out error of the mean; keep the best, or go back to it."""
        now = self._weights()
        self._set(self.mean)
        self.error = self._error()
        self._set(now)
        if self.error < self.best_error:
            self.best_error, self.best = self.error, self.mean.clone()
            return ""
        config = self.config.loop
        settled = done >= config.settled * self.task.schedule.steps
        worse = self.error > config.diverged * self.best_error
        if math.isfinite(self.error) and not (settled and worse):
            return ""
        return self._retry(done)

    def _retry(self, done: int) -> str:
        self.retries += 1
        retries = self.config.loop.retries
        if self.retries > retries:
            raise FitError(
                f"{self.task.name} network: held-out error {self.error:g} after {retries} retries "
                f"at lower rates, best {self.best_error:g}: the fit does not converge"
            )
        self._set(self.best)
        self.mean = self.best.clone()
        self.rate /= 2
        self.optimizer_step = optimizer(self.module, self.task.schedule, self.config)
        return f"diverged at step {done}: going on from the best weights at rate {self.rate:g}"

    @torch.no_grad()
    def _error(self) -> float:
        return float(self.task.objective.error(self.module, self.held_out))

    def _weights(self) -> Tensor:
        return self.module.weights.detach().clone()

    @torch.no_grad()
    def _set(self, weights: Tensor) -> None:
        self.module.weights.copy_(weights)


def _minings(schedule: Schedule) -> range:
    """The steps before which hard examples are mined."""
    every = schedule.steps // (schedule.minings + 1)
    return range(every, every * schedule.minings + 1, every) if every else range(0)


def _ema_weight(schedule: Schedule, config: LoopConfig) -> float:
    """The share of the newest weights in the running mean."""
    if schedule.optimizer == "adam":
        return 1.0
    return 1 / max(1.0, config.ema_share * schedule.steps)


def _rate_shape(schedule: Schedule, step: int, config: LoopConfig) -> float:
    """The rate at a step, relative to the schedule's."""
    if schedule.optimizer == "adam":
        return 1.0
    cosine = 0.5 * (1 + math.cos(math.pi * step / schedule.steps))
    warmed = min(1.0, (step + 1) / (config.warm_up * schedule.steps))
    return warmed * (config.final_rate + (1 - config.final_rate) * cosine)
