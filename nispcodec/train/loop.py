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
from nispcodec.dataset.hard_examples import reaches
from nispcodec.train.backend.torch.module import Module
from nispcodec.train.backend.torch.optimizer import optimizer
from nispcodec.train.prune import Mask
from nispcodec.train.quantize import round_weights
from nispcodec.train.task import Batch, Rounding, Schedule, Task

WARM_UP = 0.15
"""Share of the steps until the full rate: a fit that starts faster may learn |SDF| for good."""

AVERAGED = 0.01
"""Weights that are kept are a running mean over about this share of the steps: it is less noisy."""

CLIP = 1.0
TINY = 1e-12
CHECKS = 40
REVIEWED = 20_000
MEMORY = 0.7
"""Share of a sample's weight that is left at the next review."""

CHUNK = 25
LOSS_MEMORY = 0.99
DIVERGED = 4.0
SETTLED = 0.25
RETRIES = 4

ROUNDINGS, SLIGHT = 3, 1.05
"""Rounding sees some of the samples, and now and then overlooks what costs most: how often it is
tried at most, with others each time, and by how much the held-out error may rise before that."""
LARGE, NOTABLE = 8_000, 1.15
"""Weights from which on rounding takes long, and is tried again only where it costs so much."""


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
    After a review, half of what is drawn is samples on the wrong side
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
        self.module = Module(spec, device, task.schedule.band)
        self.held_out = Batch.of(task.held_out, device)
        self.samples = Batch.of(task.samples, device)
        if task.spec.conditioning == "chart_affine":
            self.module.place_frames(self.samples.points, self.samples.chart, self.samples.uv)
        self.reached = torch.zeros(len(self.samples))
        self.batches = self._batches()
        self.reviews = _reviews(task.schedule)
        self.rate = task.schedule.rate
        self.retries = 0
        self.move = optimizer(self.module, task.schedule)
        self.fresh = _fresh(task.schedule)
        self.mean = self._weights()
        self.best_error = math.inf
        self.best = self._weights()
        self.loss = math.nan

    def fit(self, core: AbstractContextManager[object]) -> Network:
        steps = self.task.schedule.steps
        every = max(1, steps // CHECKS)
        started = time.monotonic()
        for step in range(0, steps, CHUNK):
            with core:
                for inner in range(step, min(step + CHUNK, steps)):
                    self._step(inner)
                done = min(step + CHUNK, steps)
                note = self._check(done) if done // every > step // every or done == steps else ""
            left = (time.monotonic() - started) / done * (steps - done)
            self.listen(
                Progress(self.task.name, "fit", done, steps, self.loss, self.error, left, note)
            )
        self._set(self.best)
        if self.task.rounding is not None:
            with core:
                self._round(self.task.rounding)
        return self.module.network()

    error = math.nan

    def _step(self, step: int) -> None:
        schedule = self.task.schedule
        if step in self.reviews:
            self._review(strays=step > self.reviews[0])
        loss = self.task.loss(self.module, next(self.batches))
        self.module.weights.grad = None
        loss.backward()  # type: ignore[no-untyped-call]
        self._remember(float(loss.detach()))
        self._clip()
        self.move(self.rate * _shape(schedule, step))
        self.module.hold()
        self.mean.lerp_(self.module.weights.detach(), self.fresh)

    def _round(self, rounding: Rounding) -> None:
        """Round the best weights, again with other samples where that costs much."""
        steps, before = self.task.schedule.steps, self.best_error
        told = Progress(self.task.name, "quantize", steps, steps, self.loss, before, 0.0)
        tries: list[tuple[float, Tensor, Tensor | None]] = []
        accepted = before * (SLIGHT if len(self.best) < LARGE else NOTABLE)
        priced = self._priced(rounding)
        while len(tries) < ROUNDINGS and all(error > accepted for error, *_ in tries):
            self.listen(told)
            self._set(self.best)
            round_weights(self.module, self.samples, priced, self.generator)
            tries.append((self._error(), self._weights(), self.module.steps))
        after, self.best, self.module.steps = min(tries, key=lambda each: each[0])
        self._set(self.best)
        note = f"held-out error {before:.3g} before, {after:.3g} after"
        self.listen(replace(told, error=after, note=note))

    @torch.no_grad()
    def _priced(self, rounding: Rounding) -> Rounding:
        """With a price that is a rise of the loss, and no share of what the fit is left with."""
        if not rounding.curvature.own:
            return rounding
        left = float(self.task.loss(self.module, self.held_out))
        return replace(rounding, price=left * rounding.price)

    @torch.no_grad()
    def _review(self, strays: bool) -> None:
        """From now on draw the samples on the wrong side more often, most those that cost most."""
        samples = self.samples
        parts = torch.split(samples.points, REVIEWED)
        field = torch.cat([self.module(part)[:, 0] for part in parts])
        points, sdf, found = (part.cpu().numpy() for part in (samples.points, samples.sdf, field))
        reach = reaches(points, sdf, found, strays)
        self.reached = torch.maximum(MEMORY * self.reached, torch.from_numpy(reach))
        self.batches = self._batches()

    def _batches(self) -> Iterator[Batch]:
        """Rounds of all samples in random order; a batch never straddles two rounds.

        Where some reach, every other sample is one of these, drawn by its reach.
        """
        count, generator = len(self.samples), self.generator
        size = min(self.task.schedule.batch, count)
        reaching = self.reached.nonzero()[:, 0]
        while True:
            order = torch.randperm(count, generator=generator)
            if len(reaching):
                reach = self.reached[reaching]
                again = torch.multinomial(reach, count, True, generator=generator)
                order = torch.stack([order, reaching[again]], dim=1).flatten()
            yield from self.samples.chosen(order.to(self.samples.points.device)).parts(size)

    def _clip(self) -> None:
        gradient = self.module.weights.grad
        assert gradient is not None
        gradient.mul_((CLIP / (gradient.norm() + TINY)).clamp_(max=1.0))

    def _remember(self, loss: float) -> None:
        known = math.isfinite(self.loss)
        self.loss = LOSS_MEMORY * self.loss + (1 - LOSS_MEMORY) * loss if known else loss

    def _check(self, done: int) -> str:
        """Measure the held-out error of the mean; keep the best, or go back to it."""
        now = self._weights()
        self._set(self.mean)
        self.error = self._error()
        self._set(now)
        if self.error < self.best_error:
            self.best_error, self.best = self.error, self.mean.clone()
            return ""
        settled = done >= SETTLED * self.task.schedule.steps
        if math.isfinite(self.error) and not (settled and self.error > DIVERGED * self.best_error):
            return ""
        return self._retry(done)

    def _retry(self, done: int) -> str:
        self.retries += 1
        if self.retries > RETRIES:
            raise FitError(
                f"{self.task.name} network: held-out error {self.error:g} after {RETRIES} retries "
                f"at lower rates, best {self.best_error:g}: the fit does not converge"
            )
        self._set(self.best)
        self.mean = self.best.clone()
        self.rate /= 2
        self.move = optimizer(self.module, self.task.schedule)
        return f"diverged at step {done}: going on from the best weights at rate {self.rate:g}"

    @torch.no_grad()
    def _error(self) -> float:
        return float(self.task.error(self.module, self.held_out))

    def _weights(self) -> Tensor:
        return self.module.weights.detach().clone()

    @torch.no_grad()
    def _set(self, weights: Tensor) -> None:
        self.module.weights.copy_(weights)


def _reviews(schedule: Schedule) -> range:
    every = schedule.steps // (schedule.reviews + 1)
    return range(every, every * schedule.reviews + 1, every) if every else range(0)


def _fresh(schedule: Schedule) -> float:
    """The share of the newest weights in the running mean."""
    if schedule.optimizer == "adam":
        return 1.0
    return 1 / max(1.0, AVERAGED * schedule.steps)


def _shape(schedule: Schedule, step: int) -> float:
    """The rate at a step, relative to the schedule's."""
    if schedule.optimizer == "adam":
        return 1.0
    cosine = 0.5 * (1 + math.cos(math.pi * step / schedule.steps))
    return min(1.0, (step + 1) / (WARM_UP * schedule.steps)) * (0.01 + 0.99 * cosine)
