from __future__ import annotations

import os
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from nispcodec.catalogue.engines.processes import Processes
from nispcodec.catalogue.record import CRASH, DONE, TIMEOUT
from tests.catalogue.stubs import job, meshes, wild


@contextmanager
def engine(cores: int = 2, timeout: float = 0) -> Iterator[Processes]:
    found = Processes(wild, cores, timeout)
    try:
        yield found
    finally:
        found.close()


def ends(running: Processes, count: int) -> dict[str, str]:
    """Waits for so many jobs -> kind of failure, or status, by name."""
    found: dict[str, str] = {}
    while len(found) < count:
        for done, result in running.ended(20):
            found[Path(done.asset.source).stem] = result.record.kind or result.record.status
    return found


def test_what_one_job_does_no_other_sees(tmp_path: Path) -> None:
    source = meshes(tmp_path / "in", "dies", "hangs", "a", "b")
    with engine(cores=4, timeout=3) as running:
        for path in sorted(source.iterdir()):
            running.begin(job(path, tmp_path))
        expected = {"dies": CRASH, "hangs": TIMEOUT, "a": DONE, "b": DONE}
        assert ends(running, 4) == expected
        running.begin(job(source / "a.obj", tmp_path))
        assert ends(running, 1) == {"a": DONE}


def test_processes_are_kept_for_the_next_job_unless_they_ended(tmp_path: Path) -> None:
    source = meshes(tmp_path / "in", "a")
    with engine() as running:
        pids = []
        for _ in range(2):
            running.begin(job(source / "a.obj", tmp_path))
            pids.append(running._busy[0].pid)
            ends(running, 1)
        assert pids[0] == pids[1]
        os.kill(pids[0], signal.SIGKILL)
        while running._idle[0].alive:
            time.sleep(0.01)
        running.begin(replace(job(source / "a.obj", tmp_path), tries=2))
        assert running._busy[0].pid != pids[0]
        assert ends(running, 1) == {"a": DONE}
