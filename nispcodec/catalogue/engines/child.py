"""A child process that encodes assets, one after the other, and the handle that its parent has.

The parent sends jobs and gets results through a socket; when that closes, however the parent
ended, the child ends too. What a job does to its process, no other job sees: a process that
crashed, hangs or takes too much memory is killed, and another one takes its place.
"""

from __future__ import annotations

import os
import queue
import signal
import subprocess
import sys
import tempfile
import threading
import time
from multiprocessing import Pipe
from multiprocessing.connection import Connection

from nispcodec.catalogue.job import Encoder, Job, Result
from nispcodec.catalogue.record import CRASH, MEMORY, TIMEOUT

ENDS = 5.0
"""Seconds that a process which was killed, or whose socket is closed, has to be gone."""


class Child:
    """The parent's handle of a child.

    memory: bytes that it may allocate, 0 for any number.
    """

    def __init__(self, encode: Encoder, memory: int) -> None:
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115, as it lives as long as the child
        self.connection, theirs = Pipe()
        with theirs:
            self._process = subprocess.Popen(
                [sys.executable, "-m", __name__, str(theirs.fileno())],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=self._errors,
                pass_fds=[theirs.fileno()],
                # What is found here is found there; Ctrl-C is for the parent alone.
                env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
                start_new_session=True,
            )
        self.job: Job | None = None
        self.began = 0.0
        self.connection.send((encode, memory))

    @property
    def pid(self) -> int:
        """The number of the process."""
        return self._process.pid

    @property
    def alive(self) -> bool:
        """Whether the process has not ended yet."""
        return self._process.poll() is None

    def begin(self, job: Job) -> None:
        """Give it a job to do. What goes wrong is told by `result`."""
        self.job, self.began = job, time.monotonic()
        try:
            self.connection.send(job)
        except OSError:
            return

    def result(self) -> Result:
        """The result of its job, waited for; the record of a crash where the process ended."""
        assert self.job is not None
        try:
            found: Result = self.connection.recv()
        except (EOFError, OSError):
            found = Result(self.job.failed(CRASH, f"expected a result, found {self._end()}"))
        self.job = None
        return found

    def timed_out(self, seconds: float) -> Result:
        """Kill it -> the record of a job that took more than `seconds`."""
        assert self.job is not None
        self.close()
        said = f"expected an end within {seconds:g} s, found none: --timeout allows more"
        return Result(self.job.failed(TIMEOUT, said))

    def close(self) -> None:
        """End the process, whatever it does."""
        self._process.kill()
        self._process.wait()
        self.connection.close()
        self._errors.close()

    def _end(self) -> str:
        """How the process ended, in words."""
        try:
            code = self._process.wait(ENDS)
        except subprocess.TimeoutExpired:
            return "a process that closed its socket"
        self._errors.seek(0)
        said = self._errors.read().decode("utf-8", "replace").strip().splitlines()
        last = f" ({said[-1]})" if said else ""
        if code >= 0:
            return f"a process that ended with code {code}{last}"
        return f"a process that was ended by {signal.Signals(-code).name}{last}"


def serve(connection: Connection) -> None:
    """Do the jobs that come, until no more do; the whole life of a child."""
    encode, memory = connection.recv()
    if memory:
        _limit(memory)
    jobs: queue.SimpleQueue[Job] = queue.SimpleQueue()
    threading.Thread(target=_listen, args=(connection, jobs), daemon=True).start()
    while True:
        connection.send(_done(jobs.get(), encode))


def _done(job: Job, encode: Encoder) -> Result:
    from nispcodec.catalogue.work import work
    from nispcodec.infer.parallel import on_cores

    with on_cores(job.threads):
        return work(job, encode)


def _listen(connection: Connection, jobs: queue.SimpleQueue[Job]) -> None:
    """Take jobs as they come; without a parent there is nothing left to do."""
    try:
        while True:
            jobs.put(connection.recv())
    except (EOFError, OSError):
        os._exit(0)


def _limit(memory: int) -> None:
    """Let allocations beyond so many bytes fail, where the system can."""
    import resource

    resource.setrlimit(resource.RLIMIT_DATA, (memory, resource.getrlimit(resource.RLIMIT_DATA)[1]))


def ruined(result: Result) -> bool:
    """Whether the process that gave a result should do nothing more: memory was short in it."""
    return result.record.kind == MEMORY


if __name__ == "__main__":
    serve(Connection(int(sys.argv[1])))
