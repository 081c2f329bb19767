"""Lottery tickets: train, prune, rewind, train again (Frankle and Carbin 2019; paper, section 4.3).

All rounds have one seed, so that each of them starts from the same initial weights.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from nispcodec.core.errors import FitError
from nispcodec.core.network import Network
from nispcodec.core.progress import Listener, Progress
from nispcodec.train.backend.protocol import Engine
from nispcodec.train.cores import Core
from nispcodec.train.loop import train
from nispcodec.train.prune import STRATEGIES, Mask, everything
from nispcodec.train.task import Task


def fit(task: Task, seed: int, engine: Engine, core: Core, listen: Listener) -> Network:
    """`train`, in as many rounds as the task's pruning has, and one more before any is pruned.

    Only the last round rounds the weights: how large they are tells more before.
    Raises FitError when nothing is left of a matrix, which would leave a constant.
    """
    if task.pruning is None:
        return train(task, seed, engine, core, listen)
    if task.fitted is not None:
        mask = {name: np.asarray(tensor != 0) for name, tensor in task.fitted.tensors.items()}
        return train(task, seed, engine, core, listen, mask)
    rates = task.pruning.rates
    heard = _rounds(listen, len(rates) + 1)

    def trained(mask: Mask, rate: float) -> Network:
        for name, kept in mask.items():
            if not kept.any():
                raise FitError(
                    f"{task.name} network: nothing is left of {name}: expected a lower prune rate "
                    f"than {rates[-1]:g}, or another strategy than smallest_global"
                )
        this = task if rate == rates[-1] else replace(task, quantization=None)
        return train(this, seed, engine, core, next(heard), mask)

    *_, network = lottery_ticket(task, task.pruning.strategy, rates, trained)
    return network


def lottery_ticket(
    task: Task, strategy: str, rates: Sequence[float], trained: Callable[[Mask, float], Network]
) -> Iterator[Network]:
    """The network unpruned and at every one of some rising rates, each `trained(mask, rate)`."""
    mask = everything(task.spec)
    first = latest = trained(mask, 0.0)
    yield first
    for rate in rates:
        judged = first if strategy == "large_final" else latest
        mask = STRATEGIES[strategy](judged.tensors, mask, rate)
        latest = trained(mask, rate)
        yield latest


def _rounds(listen: Listener, count: int) -> Iterator[Listener]:
    """A listener for each round, which says which it is, and how far and how long all of them."""
    started = time.monotonic()
    for number in range(count):

        def heard(update: Progress, number: int = number) -> None:
            step, steps = number * update.steps + update.step, count * update.steps
            left = (time.monotonic() - started) * (steps - step) / step
            stage = f"{update.stage}, round {number + 1} of {count}"
            listen(replace(update, stage=stage, step=step, steps=steps, seconds_left=left))

        yield heard
