from __future__ import annotations

import os
import time
from dataclasses import replace
from mmap import MAP_ANONYMOUS, MAP_PRIVATE, mmap
from pathlib import Path

import pytest

from benchmarks.assets.source import Source
from benchmarks.codecs import Unavailable
from benchmarks.measuring.isolated import WorkFailed, isolated
from benchmarks.rate_distortion import runner
from benchmarks.rate_distortion.hull import lower_hull
from benchmarks.rate_distortion.runner import Clock, Job, plan, run
from benchmarks.rate_distortion.store import Store


def test_work_in_its_own_process_tells_time_and_memory() -> None:
    def work() -> int:
        time.sleep(0.2)
        # A map of its own: what malloc gives may have been in memory before.
        with mmap(-1, 51_200_000, flags=MAP_PRIVATE | MAP_ANONYMOUS) as block:
            for _ in range(200):
                block.write(bytes(256_000))
            return block.tell()

    answer, cost = isolated(work)
    assert answer == 51_200_000
    assert cost.seconds >= 0.2
    assert 50e6 < cost.peak_bytes < 120e6


def test_an_exception_and_a_crash_are_told_apart_from_the_rest() -> None:
    def wrong() -> None:
        raise ValueError("no such thing")

    with pytest.raises(WorkFailed, match="ValueError: no such thing"):
        isolated(wrong)
    with pytest.raises(WorkFailed, match="code 7"):
        isolated(lambda: os._exit(7))


def test_hull_keeps_what_no_mix_of_others_beats() -> None:
    pairs = [(100, 1.0), (1000, 0.1), (300, 0.9), (320, 0.2), (2000, 0.1), (90, 2.0)]
    assert lower_hull(pairs) == [5, 0, 3, 1]


def test_finished_points_are_not_run_again_and_failures_are(tmp_path: Path) -> None:
    store, job = Store(tmp_path), Job(Path("a.obj"), "c", {"q": 1})
    record = {"asset": "a", "codec": "c", "setting": {"q": 1}}
    assert not job.done(store)
    store.put(record | {"failure": "bad luck"}, b"")
    assert not job.done(store)
    store.put(record | {"bytes": 3}, b"abc")
    assert job.done(store)
    assert store.file(record) == b"abc"
    assert store.records() == [record | {"bytes": 3}]
    drawing = replace(job, draw=True)
    assert not drawing.done(store)
    store.put(record | {"bytes": 3, "pictures": {"psnr": 30.0}}, picture=b"webp")
    assert drawing.done(store)
    assert (store.file(record), store.picture(record)) == (b"abc", b"webp")


def test_a_failed_point_is_a_record_and_leaves_the_next_alone(tmp_path: Path) -> None:
    store, path = Store(tmp_path / "points"), tmp_path / "cloud.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n")
    jobs = [Job(path, "glb", {}), Job(tmp_path / "absent.obj", "glb", {})]
    found = {each.record["asset"]: each.record for each in run(jobs, store, workers=1)}
    assert found["cloud"]["metrics"]["geometry"]["larger"]["max"] < 1e-6
    assert "absent.obj" in found["absent"]["failure"]
    assert store.find("absent", "glb", {}) == found["absent"]


class Stub:
    def settings(self, source: Source, quick: bool) -> list[dict[str, int]]:
        if source.name == "missing":
            raise Unavailable("not here")
        if source.name == "bad":
            raise ValueError("cannot be read")
        return [{"q": 1}, {"q": 2}]


def test_plan_goes_on_past_what_cannot_run(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runner, "codec", lambda name: Stub())
    chosen = [Source(Path(f"{name}.obj")) for name in ("missing", "bad", "good")]
    planned = [each for source in chosen for each in plan(source, ["c"], quick=False)]
    assert planned[0] == {"asset": "missing", "codec": "c", "setting": {}, "skipped": "not here"}
    assert isinstance(planned[1], dict)
    assert planned[1]["failure"] == "ValueError: cannot be read"
    assert planned[2:] == [Job(Path("good.obj"), "c", {"q": n}) for n in (1, 2)]


def test_time_left_is_told_by_codec() -> None:
    jobs = [Job(Path("a.obj"), name, {}) for name in ("fast", "fast", "slow", "slow")]
    clock = Clock(jobs, workers=2)
    assert clock.left("fast", 1.0) == pytest.approx(1.5)
    assert clock.left("slow", 99.0) == pytest.approx(50.0)
