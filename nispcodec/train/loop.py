"""The training loop: one network, one task, the best weights by held-out error."""

from __future__ import annotations

import math
import time
from dataclasses import replace
from itertools import pairwise
from operator import attrgetter

import numpy as np

from nispcodec.core.arrays import Float32Array, Float64Array, FloatArray
from nispcodec.core.errors import FitError
from nispcodec.core.memory import give_back
from nispcodec.core.network import MAX_INIT_SEED, Network
from nispcodec.core.progress import Listener, Progress
from nispcodec.train.backend.protocol import Engine
from nispcodec.train.batches import Batches
from nispcodec.train.config import LoopConfig
from nispcodec.train.cores import Core
from nispcodec.train.initialization import initial_weights, place_chart_affine
from nispcodec.train.layout import WeightLayout
from nispcodec.train.prune import Mask
from nispcodec.train.quantize import Unrounded, round_weights
from nispcodec.train.task import Quantization, Schedule, Task


def train(
    task: Task,
    seed: int,
    engine: Engine,
    core: Core,
    listen: Listener,
    mask: Mask | None = None,
) -> Network:
    """Fit one network; `core` is held while computing, so that tasks share the cores fairly.

    What a `mask` prunes is 0 from the first step to the last; initial weights depend on the seed.
    After hard examples were mined, every other sample of a batch is one of these
    (`nispcodec.dataset.hard_examples`).

    A run whose held-out error explodes goes on from its best weights at half the rate; where lower
    rates do not help, the best network so far is what there is, and a note says so. A run that
    ended far worse than was foreseen is made again from another seed, unless a `mask`
    ties it to its initial weights; the better of the two stays. So does the best of as many runs as
    the task has `starts`. At the end the weights are rounded (`nispcodec.train.quantize`), if the
    task says how. A network that was fitted before is only rounded.
    Raises FitError for a network that is far worse than a constant, whose weights cannot be
    rounded, or that the engine does not train.
    """
    if task.fitted is not None:
        run = _Run(task, seed, engine, core, listen, mask)
        run.take(task.fitted)
        return run.network()
    starts, began = task.starts if mask is None else 1, time.monotonic()
    runs = (
        _fitted(_Run(task, each, engine, core, _part(listen, number, starts, began), mask))
        for number, each in enumerate(_seeds(seed, starts))
    )
    run = min(runs, key=attrgetter("comparable_error"))
    if mask is None and run.went_wrong:
        run = min(run, _made_again(run, seed, engine), key=attrgetter("comparable_error"))
    return run.network()


def _seeds(seed: int, count: int) -> list[int]:
    """Seeds whose initial weights are as far from each other as they can be."""
    return [seed + number * (MAX_INIT_SEED + 1) // count for number in range(count)]


def _part(listen: Listener, number: int, count: int, began: float) -> Listener:
    """A listener to one run of several, which are told as one; rounding comes after all of them."""

    def heard(update: Progress) -> None:
        steps = count * update.steps
        done = number * update.steps + update.step if update.stage == "fit" else steps
        left = (time.monotonic() - began) * (steps - done) / done
        listen(replace(update, step=done, steps=steps, seconds_left=left))

    return heard


def _fitted(run: _Run) -> _Run:
    run.fit()
    return run


def _made_again(run: _Run, seed: int, engine: Engine) -> _Run:
    """Another run of the same task, from the initial weights that are furthest from this seed's.

    It is told as if all steps had been done before: they had.
    """
    task, config = run.task, run.config.loop
    steps = max(1, round(config.again_steps * task.schedule.steps))
    task_again = replace(task, schedule=replace(task.schedule, steps=steps))

    def heard(update: Progress) -> None:
        run.listen(replace(update, step=task.schedule.steps, steps=task.schedule.steps))

    return _fitted(_Run(task_again, _seeds(seed, 2)[1], engine, run.core, heard, None))


class _Run:
    error = math.nan
    loss = math.nan
    best_error = math.inf
    retries = 0

    def __init__(
        self,
        task: Task,
        seed: int,
        engine: Engine,
        core: Core,
        listen: Listener,
        mask: Mask | None,
    ) -> None:
        self.task, self.config = task, task.config
        self.core, self.listen = core, listen
        self.random = np.random.default_rng(seed)
        init_seed = task.fitted.spec.init_seed if task.fitted else seed % (MAX_INIT_SEED + 1)
        self.layout = WeightLayout(replace(task.spec, init_seed=init_seed))
        self.first = initial_weights(self.layout.spec, task.schedule.w0_scale)
        self.kept = self.layout.kept(mask)
        self.trainer = engine.trainer(task, self._start(), self.kept)
        self.best = self.trainer.weights
        mines = task.schedule.minings and task.fitted is None
        self.error_radii = engine.error_radii(task) if mines else None
        self.batches = Batches(len(task.samples), task.schedule.batch, self.random)
        self.hardness: FloatArray = np.zeros(len(task.samples), dtype=np.float32)
        self.rates = _rates(task.schedule, self.config.loop)

    @property
    def comparable_error(self) -> float:
        """The best held-out error; infinite where there was none."""
        return self.best_error if math.isfinite(self.best_error) else math.inf

    @property
    def went_wrong(self) -> bool:
        """Whether it ended far worse than was foreseen, and than anybody would not notice."""
        config, task = self.config.loop, self.task
        fine = config.again_unnoticed * task.objective.good
        return self.comparable_error > config.went_wrong * max(task.foreseen, fine)

    def fit(self) -> None:
        """Do all steps, and keep the weights with the best held-out error."""
        started, minings = time.monotonic(), _minings(self.task.schedule)
        for start, stop in _spans(self.task.schedule, minings, self.config.loop):
            with self.core() as threads:
                if start in minings:
                    self._mine_hard_examples(floaters=start > minings[0])
                self._advance(start, stop, threads)
                note = self._check(stop) if self._is_check(start, stop) else ""
            given_up = self.retries > self.config.loop.retries
            left = (time.monotonic() - started) / stop * (self.task.schedule.steps - stop)
            warning = self._given_up() if given_up else ""
            self._tell("fit", stop, self.error, left, note, warning)
            if given_up:
                break
        if self.went_wrong:
            self._tell("fit", self.task.schedule.steps, self.best_error, 0.0, self._wrong())

    def take(self, fitted: Network) -> None:
        """Have the weights of a network that was fitted before."""
        self.best = self.layout.vector(fitted.tensors)
        self.best_error = self.error = self._error(self.best)

    def network(self) -> Network:
        """The best weights, rounded if the task says how. Raises FitError if they are useless."""
        self._expect_useful()
        # What only the fit needed is free for the rounding, which takes as much.
        self.error_radii = None
        give_back()
        with self.core():
            return self._network()

    def _start(self) -> Float32Array:
        weights = self.first.copy()
        if self.layout.spec.conditioning == "chart_affine":
            place_chart_affine(weights, self.layout, self.task.samples, self.config.affine_ridge)
        return weights

    def _advance(self, start: int, stop: int, threads: int) -> None:
        self.trainer.threads = min(threads, self.config.loop.most_threads)
        rows = self.batches.take(stop - start)
        for loss in self.trainer.steps(rows, self.rates[start:stop]).tolist():
            memory = self.config.loop.loss_memory if math.isfinite(self.loss) else 0.0
            self.loss = memory * self.loss + (1 - memory) * loss if memory else loss

    def _is_check(self, start: int, stop: int) -> bool:
        steps = self.task.schedule.steps
        every = max(1, steps // self.config.loop.checks)
        return stop // every > start // every or stop == steps

    def _check(self, done: int) -> str:
        """Measure the held-out error of the mean; keep the best, or go back to it."""
        mean, config, objective = self.trainer.mean, self.config.loop, self.task.objective
        self.error = self._error(mean)
        if self.error < self.best_error:
            self.best_error, self.best = self.error, mean
            return ""
        settled = done >= config.settled * self.task.schedule.steps
        worse = self.error > config.diverged * max(self.best_error, objective.good)
        if math.isfinite(self.error) and not (settled and worse):
            return ""
        return self._retry(done)

    def _retry(self, done: int) -> str:
        self.retries += 1
        if self.retries > self.config.loop.retries:
            return ""
        self.trainer.restart(self.best)
        self.rates = (self.rates / 2).astype(np.float32)
        rate = self.task.schedule.rate / 2**self.retries
        return f"diverged at step {done}: going on from the best weights at rate {rate:g}"

    def _wrong(self) -> str:
        return (
            f"held-out error {self.best_error:.3g}, foreseen {self.task.foreseen:.3g}: a fit that "
            "went wrong"
        )

    def _given_up(self) -> str:
        return (
            f"{self.task.name} network: held-out error {self.error:g} after "
            f"{self.config.loop.retries} retries at lower rates: the best network so far is kept, "
            f"held-out error {self.best_error:g}"
        )

    def _expect_useful(self) -> None:
        objective, held_out = self.task.objective, self.task.held_out
        constant = max(objective.ignorance(held_out), objective.good)
        if not self.best_error <= self.config.loop.useless * constant:
            raise FitError(
                f"{self.task.name} network: expected a held-out error below that of a constant, "
                f"{constant:.3g}, found {self.best_error:.3g}: the fit does not converge"
            )

    def _mine_hard_examples(self, floaters: bool) -> None:
        """From now on take samples on the wrong side more often, most those that cost most."""
        assert self.error_radii is not None
        samples, config = self.task.samples, self.config.hard_examples
        field = self.trainer.outputs(self.trainer.weights, samples.points, samples.chart)[:, 0]
        radii = self.error_radii(field, config.error_radius, floaters)
        self.hardness = np.maximum(config.memory * self.hardness, radii)
        self.batches.prefer(self.hardness)

    def _network(self) -> Network:
        if self.task.quantization is None:
            return self.layout.network(self.best)
        weights, steps = self._rounded(self.task.quantization)
        return self.layout.network(weights, steps)

    def _rounded(self, quantization: Quantization) -> tuple[Float32Array, Float64Array]:
        """The best weights rounded, again with other samples where that costs much."""
        before, config = self.best_error, self.config.quantize
        unrounded = Unrounded(
            self.task, self.layout, self.trainer, self.best, self.first, self.kept
        )
        usual = config.slight if len(self.best) < config.large else config.notable
        rise = max(usual, quantization.rise)
        absolute = self._absolute(quantization)
        spoiled = config.spoiled * max(before, config.unnoticed * self.task.objective.good)
        tries: list[tuple[float, Float32Array, Float64Array]] = []
        while len(tries) < config.tries and all(error > before * rise for error, *_ in tries):
            self._tell("quantize", self.task.schedule.steps, before, 0.0, "")
            weights, steps = round_weights(unrounded, absolute, self.random)
            tries.append((self._error(weights), weights, steps))
            if tries[-1][0] > spoiled:
                absolute = replace(absolute, lambda_=config.finer * absolute.lambda_)
        after, weights, steps = min(tries, key=lambda each: each[0])
        note = f"held-out error {before:.3g} before, {after:.3g} after"
        self._tell("quantize", self.task.schedule.steps, after, 0.0, note)
        return weights, steps

    def _absolute(self, quantization: Quantization) -> Quantization:
        """With a lambda that is a rise of the loss, and no share of what the fit is left with."""
        if not self.task.objective.own_curvature:
            return quantization
        left = self.task.objective.loss(self._outputs(self.best), self.task.held_out)
        return replace(quantization, lambda_=left * quantization.lambda_)

    def _error(self, weights: Float32Array) -> float:
        outputs = self._outputs(weights)
        if not np.isfinite(outputs).all():
            return math.nan
        return self.task.objective.error(outputs, self.task.held_out)

    def _outputs(self, weights: Float32Array) -> Float32Array:
        held_out = self.task.held_out
        return self.trainer.outputs(weights, held_out.points, held_out.chart)

    def _tell(
        self, stage: str, step: int, error: float, left: float, note: str, warning: str = ""
    ) -> None:
        name, steps = self.task.name, self.task.schedule.steps
        told = Progress(name, stage, step, steps, self.loss, error, left, note)
        self.listen(replace(told, warning=warning))


def _minings(schedule: Schedule) -> range:
    """The steps before which hard examples are mined."""
    every = schedule.steps // (schedule.minings + 1)
    return range(every, every * schedule.minings + 1, every) if every else range(0)


def _spans(schedule: Schedule, minings: range, config: LoopConfig) -> list[tuple[int, int]]:
    """The runs of steps between two looks at progress; a mining begins one."""
    bounds = {*range(0, schedule.steps, config.chunk), *minings, schedule.steps}
    return list(pairwise(sorted(bounds)))


def _rates(schedule: Schedule, config: LoopConfig) -> Float32Array:
    """The rate of every step."""
    steps = np.arange(schedule.steps)
    if schedule.optimizer == "adam":
        return np.full(schedule.steps, schedule.rate, dtype=np.float32)
    cosine = 0.5 * (1 + np.cos(np.pi * steps / schedule.steps))
    warmed = np.minimum(1.0, (steps + 1) / (config.warm_up * schedule.steps))
    shape = warmed * (config.final_rate + (1 - config.final_rate) * cosine)
    return (schedule.rate * shape).astype(np.float32)
