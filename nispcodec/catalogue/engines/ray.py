"""The engine of a Ray cluster: a task for each job, in a child of the process that Ray runs it in.

A task gets its cores from Ray, and keeps the child for the next one, as the engine of one machine
does: the same code, the same bytes. What crashes, hangs or takes too much memory is the child
alone; a machine that is lost is told by Ray, and its job is tried again. Inputs and outputs go by
path or URL, never through Ray's object store: jobs and records of a few kilobytes do.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from nispcodec.catalogue.config import BatchConfig
from nispcodec.catalogue.engines.child import Child, ruined
from nispcodec.catalogue.job import Encoder, Job, Result
from nispcodec.catalogue.record import CRASH
from nispcodec.core.errors import NispError
from nispcodec.core.extras import require

AHEAD = 2
"""Jobs that are with Ray for each core of the cluster: the next one is there when one ends, and a
cluster that grows on demand sees demand."""


class RayTasks:
    """Tasks of Ray, on the cluster at `config.address`, or on one that it begins here.

    Raises NispError without the extra `ray`, and for more memory than any machine has.
    """

    def __init__(self, encode: Encoder, config: BatchConfig) -> None:
        require("ray", extra="ray", what_for="--engine ray")
        import ray

        self._ray: Any = ray
        self._ours = not ray.is_initialized()
        if self._ours:
            here = {} if config.address else {"num_cpus": config.jobs_here()}
            ray.init(config.address or None, log_to_driver=False, logging_level="error", **here)
        # The driver counts the tries, of crashes as of machines that are lost.
        self._task = ray.remote(max_retries=0)(run_job)
        self._encode = ray.put(encode)
        self._config = config
        self._jobs: dict[Any, Job] = {}
        most = int(self._largest("memory"))
        if config.memory > most:
            self.close()
            found = f"found one of {most:,} at most"
            raise NispError(f"memory: expected a machine with {config.memory:,} bytes, {found}")

    @property
    def cores(self) -> int:
        """Those of the cluster, and as many jobs that wait for one."""
        found = int(self._ray.cluster_resources().get("CPU", 1))
        return AHEAD * (min(found, self._config.jobs) if self._config.jobs else max(1, found))

    def begin(self, job: Job) -> None:
        """Give the job to Ray, with as many of its cores as it takes."""
        # More than one machine has would be waited for forever.
        threads = max(1, min(job.threads // AHEAD, int(self._largest("CPU"))))
        config, own = self._config, replace(job, threads=threads)
        asked = self._task.options(num_cpus=threads, memory=config.memory or None)
        task = asked.remote(self._encode, own, config.timeout, config.memory)
        self._jobs[task] = job

    def ended(self, seconds: float) -> Iterator[tuple[Job, Result]]:
        """The jobs that have ended."""
        if not self._jobs:
            return
        ready, _ = self._ray.wait(list(self._jobs), num_returns=1, timeout=seconds)
        for task in ready:
            job = self._jobs.pop(task)
            try:
                yield job, self._ray.get(task)
            except self._ray.exceptions.RayError as why:
                said = f"expected a result, found that Ray lost the task: {type(why).__name__}"
                yield job, Result(job.failed(CRASH, said))

    def close(self) -> None:
        """Cancel what is left; end the cluster, if it was begun here."""
        for task in self._jobs:
            self._ray.cancel(task, force=True)
        self._jobs = {}
        if self._ours:
            self._ray.shutdown()

    def _largest(self, resource: str) -> float:
        """The most that one machine of the cluster has of a resource."""
        alive = [each["Resources"] for each in self._ray.nodes() if each["Alive"]]
        return max((each.get(resource, 0.0) for each in alive), default=0.0)


_child: list[Child] = []
"""The child of this process, a worker of Ray, if it has one."""


def run_job(encode: Encoder, job: Job, timeout: float, memory: int) -> Result:
    """One task of Ray: the job's result, by the child of this process."""
    if not _child or not _child[0].alive:
        _drop()
        _child.append(Child(encode, memory))
    child = _child[0]
    child.begin(job)
    if not child.connection.poll(timeout or None):
        _child.clear()
        return child.timed_out(timeout)
    result = child.result()
    if result.record.kind == CRASH or ruined(result):
        _drop()
    return result


def _drop() -> None:
    while _child:
        _child.pop().close()
