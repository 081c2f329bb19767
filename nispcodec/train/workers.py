"""Fit several networks at once, on as many cores as asked.

Each network has a process of its own: the steps are so short that threads would wait for Python's
lock most of the time.
"""

from __future__ import annotations

import multiprocessing
import queue
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from multiprocessing.context import ForkContext, SpawnContext
from multiprocessing.process import BaseProcess
from multiprocessing.queues import Queue

import torch

from nispcodec.core.errors import FitError
from nispcodec.core.network import Network
from nispcodec.core.progress import Listener, Progress
from nispcodec.train.lottery_ticket import fit
from nispcodec.train.task import Task

Message = tuple[str, Progress | Network | Exception]
Core = AbstractContextManager[object]
Context = ForkContext | SpawnContext


def fit_networks(
    tasks: list[Task], seed: int, device: str, threads: int, listen: Listener
) -> dict[str, Network]:
    """Fit all tasks in parallel; `threads` of them compute at any moment.

    The first, which should be the longest, has a core to itself, and leaves it to the others, who
    share what is left, when it is done.
    The result depends on the tasks, the seed and the device alone. An exception in one task, or
    Ctrl-C, stops the others.
    """
    context = _context(device)
    messages: Queue[Message] = context.Queue()
    shared = context.Semaphore(max(1, threads - 1))
    cores: list[Core] = [nullcontext() if threads > 1 else shared, *[shared] * (len(tasks) - 1)]
    workers = {
        task.name: _started(context, task, seed, device, core, messages)
        for task, core in zip(tasks, cores, strict=True)
    }

    def done(name: str) -> None:
        if name == tasks[0].name and threads > 1:
            shared.release()

    with _ended(list(workers.values())):
        networks = _collected(workers, messages, listen, done)
    return {task.name: networks[task.name] for task in tasks}


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


def _context(device: str) -> Context:
    """Forked where that is safe: nothing is imported or copied again."""
    if sys.platform == "linux" and device == "cpu":
        return multiprocessing.get_context("fork")
    return multiprocessing.get_context("spawn")


def _started(
    context: Context, task: Task, seed: int, device: str, core: Core, messages: Queue[Message]
) -> BaseProcess:
    arguments = (task, seed, device, core, messages)
    process = context.Process(target=_work, args=arguments, daemon=True)
    process.start()
    return process


def _work(task: Task, seed: int, device: str, core: Core, messages: Queue[Message]) -> None:
    """The work of a process: tell progress, then the network or what went wrong.

    Ctrl-C reaches every process; only the one that started the others answers it. Should that one
    be killed, nobody is left to want an answer.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    torch.set_num_threads(1)

    def tell(update: Progress) -> None:
        if _orphaned():
            messages.cancel_join_thread()
            sys.exit(1)
        messages.put((task.name, update))

    try:
        messages.put((task.name, fit(task, seed, device, core, tell)))
    except Exception as error:
        messages.put((task.name, error))


def _orphaned() -> bool:
    parent = multiprocessing.parent_process()
    return parent is not None and not parent.is_alive()


def _collected(
    workers: dict[str, BaseProcess],
    messages: Queue[Message],
    listen: Listener,
    done: Callable[[str], None],
) -> dict[str, Network]:
    networks: dict[str, Network] = {}
    while len(networks) < len(workers):
        try:
            name, told = messages.get(timeout=1.0)  # then look whether every process is there
        except queue.Empty:
            _check_alive(workers, networks)
            continue
        if isinstance(told, Exception):
            raise told
        if isinstance(told, Progress):
            listen(told)
        else:
            networks[name] = told
            done(name)
    return networks


def _check_alive(workers: dict[str, BaseProcess], networks: dict[str, Network]) -> None:
    for name, worker in workers.items():
        if name not in networks and worker.exitcode:
            raise FitError(
                f"{name} network: its process ended with code {worker.exitcode}; out of memory?"
            )


@contextmanager
def _ended(workers: list[BaseProcess]) -> Iterator[None]:
    try:
        yield
    finally:
        for worker in workers:
            worker.terminate()
        for worker in workers:
            worker.join()
