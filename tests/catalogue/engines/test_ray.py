"""The engine of Ray: the work of a task without Ray, and whole batches where Ray is installed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import pytest

from nispcodec.catalogue.config import BatchConfig
from nispcodec.catalogue.engines import ray as engine
from nispcodec.catalogue.engines.ray import RayTasks, run_job
from nispcodec.catalogue.record import CRASH, DONE, TIMEOUT
from nispcodec.core.errors import NispError
from tests.catalogue.stubs import batch, job, meshes, quick, ran, wild

needs_ray = pytest.mark.skipif(find_spec("ray") is None, reason="Ray: extra `ray`")


@pytest.fixture(autouse=True)
def no_child_is_left() -> Iterator[None]:
    yield
    engine._drop()


def test_a_task_keeps_its_child_until_that_is_ruined(tmp_path: Path) -> None:
    source = meshes(tmp_path / "in", "a", "dies", "hangs")

    def kind(name: str) -> str:
        done = run_job(wild, job(source / f"{name}.obj", tmp_path), 4, 0).record
        return done.kind or done.status

    assert kind("a") == DONE
    first = engine._child[0].pid
    assert kind("a") == DONE
    assert engine._child[0].pid == first
    assert kind("dies") == CRASH
    assert not engine._child
    assert kind("hangs") == TIMEOUT
    assert not engine._child
    assert kind("a") == DONE


def test_without_ray_one_sentence_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("nispcodec.core.extras.find_spec", lambda name: None)
    with pytest.raises(NispError, match=r"pip install 'nispcodec\[ray\]'"):
        RayTasks(quick, BatchConfig(engine="ray"))


@needs_ray
@pytest.mark.slow
def test_a_cluster_does_the_same_to_the_byte_and_loses_nothing(tmp_path: Path) -> None:
    names = ("a", "b", "c", "x/d", "dies", "refused", "hangs")
    source, near, far = meshes(tmp_path / "in", *names), tmp_path / "near", tmp_path / "far"
    config = BatchConfig(jobs=2, thumbnail=0, timeout=4)
    here = ran([source], batch(near, wild, config))
    there = ran([source], batch(far, wild, replace(config, engine="ray")))
    assert {name: (each.record.kind, each.record.tries) for name, each in here.items()} == {
        name: (each.record.kind, each.record.tries) for name, each in there.items()
    }
    for path in near.rglob("*.nisp"):
        assert path.read_bytes() == (far / path.relative_to(near)).read_bytes()
    assert len(list(far.rglob("*.nisp"))) == 4
    with pytest.raises(NispError, match="expected a machine with"):
        ran([source], batch(far, wild, replace(config, engine="ray", memory=10**18)))
