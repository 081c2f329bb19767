"""Fit several networks at once, on as many cores as asked."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from concurrent.futures import FIRST_EXCEPTION, ThreadPoolExecutor, wait
from contextlib import contextmanager, nullcontext

import torch

from nispcodec.errors import FitError
from nispcodec.fit.task import Task
from nispcodec.fit.tickets import fit
from nispcodec.fit.train import Cancelled
from nispcodec.network import Network
from nispcodec.progress import Listener, Progress

# Each network is so small that one core an operation is fastest; the networks run side by side.
CORES_PER_OPERATION = 1


def fit_networks(
    tasks: list[Task], seed: int, device: str, threads: int, listen: Listener
) -> dict[str, Network]:
    """Fit all tasks in parallel; `threads` of them compute at any moment.

    The first, which should be the longest, has a core to itself; the others share what is left.
    The result depends on the tasks, the seed and the device alone. An exception in one task, or
    Ctrl-C, stops the others.
    """
    shared, stop = threading.Semaphore(max(1, threads - 1)), threading.Event()
    first = nullcontext() if threads > 1 else shared

    def heard(progress: Progress) -> None:
        if stop.is_set():
            raise Cancelled
        listen(progress)

    with _single_core_operations(), ThreadPoolExecutor(len(tasks)) as pool:
        futures = {
            task.name: pool.submit(fit, task, seed, device, shared if turn else first, heard)
            for turn, task in enumerate(tasks)
        }
        try:
            done = wait(futures.values(), return_when=FIRST_EXCEPTION).done
            for future in done:
                future.result()
        except BaseException:
            stop.set()
            raise
    return {name: future.result() for name, future in futures.items()}


def resolve_device(wanted: str) -> str:
    """The torch device for "auto", "cpu", "cuda" or "cuda:1"; auto is CUDA when there is one.

    Raises FitError for a device that is not there.
    """
    cuda = torch.cuda.is_available()
    if wanted == "auto":
        return "cuda" if cuda else "cpu"
    if wanted != "cpu" and not (cuda and wanted.partition(":")[0] == "cuda"):
        found = "cpu, cuda" if cuda else "cpu alone"
        raise FitError(f"device: expected one that torch finds here ({found}), found {wanted!r}")
    return wanted


@contextmanager
def _single_core_operations() -> Iterator[None]:
    before = torch.get_num_threads()
    torch.set_num_threads(CORES_PER_OPERATION)
    try:
        yield
    finally:
        torch.set_num_threads(before)
