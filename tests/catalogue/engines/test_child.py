from __future__ import annotations

import os
import signal
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from nispcodec.catalogue.engines.child import Child, ruined
from nispcodec.catalogue.record import CRASH, MEMORY, TIMEOUT
from tests.catalogue.stubs import job, meshes, wild


@pytest.fixture(scope="module")
def source(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return meshes(tmp_path_factory.mktemp("in"), "a", "b", "dies", "hungry", "hangs")


@pytest.fixture
def child() -> Iterator[Child]:
    found = Child(wild, memory=4_000_000_000)
    yield found
    found.close()


def test_one_process_does_job_after_job(child: Child, source: Path, tmp_path: Path) -> None:
    for name in ("a", "b"):
        child.begin(job(source / f"{name}.obj", tmp_path))
        assert child.result().record.done
    assert child.alive


def test_too_much_memory_fails_the_job(child: Child, source: Path, tmp_path: Path) -> None:
    child.begin(job(source / "hungry.obj", tmp_path))
    result = child.result()
    assert result.record.kind == MEMORY
    assert ruined(result)


def test_a_process_that_dies_is_a_crash_in_words(
    child: Child, source: Path, tmp_path: Path
) -> None:
    child.begin(job(source / "dies.obj", tmp_path))
    record = child.result().record
    assert (record.kind, record.output) == (CRASH, "dies.nisp")
    assert "ended by SIGABRT" in record.error
    child.begin(job(source / "a.obj", tmp_path))
    assert child.result().record.kind == CRASH


def test_a_job_that_never_ends_is_killed(child: Child, source: Path, tmp_path: Path) -> None:
    child.begin(job(source / "hangs.obj", tmp_path))
    record = child.timed_out(0.5).record
    assert record.kind == TIMEOUT
    assert "within 0.5 s" in record.error
    assert not child.alive


def test_without_a_parent_it_ends_though_it_is_busy(
    child: Child, source: Path, tmp_path: Path
) -> None:
    child.begin(job(source / "a.obj", tmp_path))
    child.result()
    child.begin(job(source / "hangs.obj", tmp_path))
    child.connection.close()
    until = time.monotonic() + 20
    while child.alive and time.monotonic() < until:
        time.sleep(0.05)
    assert not child.alive


def test_ctrl_c_is_for_the_parent_alone(child: Child) -> None:
    assert os.getsid(child.pid) != os.getsid(0)
    os.kill(child.pid, signal.SIGKILL)
