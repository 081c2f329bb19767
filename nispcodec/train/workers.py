"""Fit several networks at once, on as many cores as asked.

Each network has a thread of its own: a backend computes whole runs of steps outside of Python's
lock.
"""

from __future__ import annotations

import queue
import threading

from threadpoolctl import threadpool_limits

from nispcodec.core.network import Network
from nispcodec.core.progress import Listener, Progress
from nispcodec.train.backend.protocol import Engine
from nispcodec.train.cores import Core, Cores, Stopped
from nispcodec.train.lottery_ticket import fit
from nispcodec.train.task import Task

Message = tuple[int, Progress | Network | BaseException]


def fit_networks(
    tasks: list[Task], seed: int, engine: Engine, threads: int, listen: Listener
) -> dict[str, Network]:
    """Fit all tasks in parallel; `threads` of them compute at any moment.

    The result depends on the tasks, the seed and the engine alone. An exception in one task, or
    Ctrl-C, stops the others. `listen` is called from the calling thread. Raises FitError, as a fit
    does.
    """
    messages: queue.SimpleQueue[Message] = queue.SimpleQueue()
    cores = Cores(threads, len(tasks))
    # Matrix products of several threads would wait for each other, and sum in another order.
    with threadpool_limits(1):
        try:
            for number, task in enumerate(tasks):
                work = (number, task, engine, seed, cores.of(number), messages)
                name = f"fit {task.name}"
                threading.Thread(target=_work, args=work, daemon=True, name=name).start()
            networks = _collected(len(tasks), messages, listen, cores)
        finally:
            cores.stop()
    return {task.name: networks[number] for number, task in enumerate(tasks)}


def _work(
    number: int,
    task: Task,
    engine: Engine,
    seed: int,
    core: Core,
    messages: queue.SimpleQueue[Message],
) -> None:
    """The work of a thread: tell progress, then the network or what went wrong."""
    try:
        found = fit(task, seed, engine, core, lambda update: messages.put((number, update)))
        messages.put((number, found))
    except Stopped:
        return
    except BaseException as error:
        messages.put((number, error))


def _collected(
    count: int, messages: queue.SimpleQueue[Message], listen: Listener, cores: Cores
) -> dict[int, Network]:
    networks: dict[int, Network] = {}
    while len(networks) < count:
        number, told = messages.get()
        if isinstance(told, BaseException):
            raise told
        if isinstance(told, Progress):
            listen(told)
        else:
            networks[number] = told
            cores.done(number)
    return networks
