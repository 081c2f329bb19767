"""Whole batches with a stub for the encoder: restarts, failures, shards, two drivers."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

import nispcodec
from nispcodec.catalogue.batch import remove_temporaries
from nispcodec.catalogue.config import BatchConfig
from nispcodec.catalogue.find import find_assets
from nispcodec.catalogue.job import Result
from nispcodec.catalogue.ledger import ledger_name, merge
from nispcodec.catalogue.many import encode_many
from nispcodec.catalogue.plan import Shard
from nispcodec.core.errors import NispError
from nispcodec.format import pack
from tests.catalogue.stubs import PLAIN, batch, few_steps, meshes, once, quick, ran, wild
from tests.metrics.shapes import sphere


def statuses(results: dict[str, Result]) -> dict[str, str]:
    return {name: each.record.status for name, each in results.items()}


def lines(folder: Path, name: str = "catalogue.jsonl") -> dict[str, dict[str, object]]:
    found = map(json.loads, (folder / name).read_text().splitlines())
    return {each["output"] or each["source"]: each for each in found}


def test_the_rest_goes_on_and_the_next_run_does_what_failed(tmp_path: Path) -> None:
    source, out = meshes(tmp_path / "in", "a", "b", "x/a", "refused", "buggy"), tmp_path / "out"
    first = ran([source, tmp_path / "gone"], batch(out, wild))
    assert statuses(first) == {
        "a.nisp": "done", "b.nisp": "done", "x/a.nisp": "done",
        "refused.nisp": "failed", "buggy.nisp": "failed", str(tmp_path / "gone"): "failed",
    }  # fmt: skip
    assert set(lines(out)) == set(first)
    assert (out / "catalogue.html").read_text().count('<tr class="failed">') == 3
    (source / "b.obj").write_text((source / "b.obj").read_text() + "# changed\n")
    second = ran([source], batch(out, quick))
    assert {name for name, each in second.items() if each.kept} == {"a.nisp", "x/a.nisp"}
    assert all(each.record.done for each in second.values())
    assert set(lines(out)) == set(second)
    third = ran([source / "a.obj"], batch(out, quick))
    assert list(third) == ["a.nisp"]
    assert set(lines(out)) == set(second)


def test_an_asset_that_crashed_once_is_done(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "marks").mkdir()
    monkeypatch.setenv("NISP_TEST_MARKS", str(tmp_path / "marks"))
    source = meshes(tmp_path / "in", "a")
    (result,) = ran([source], batch(tmp_path / "out", once)).values()
    assert (result.record.status, result.record.tries) == ("done", 2)
    (tmp_path / "marks" / "a").unlink()
    none = replace(PLAIN, retries=0)
    (result,) = ran([source], batch(tmp_path / "other", once, none)).values()
    assert (result.record.status, result.record.tries) == ("failed", 1)


def test_closing_it_early_leaves_what_can_be_gone_on_with(tmp_path: Path) -> None:
    source, out = meshes(tmp_path / "in", "a", "b", "slow-c", "slow-d"), tmp_path / "out"
    found = find_assets([str(source)])
    results = batch(out, wild, replace(PLAIN, jobs=1)).run(list(found))
    first = next(results).record.output
    results.close()
    assert list(lines(out)) == [first]
    assert not list(out.glob(".*"))
    again = ran([source], batch(out, wild))
    assert [name for name, each in again.items() if each.kept] == [first]
    assert len(again) == 4


def test_a_second_driver_is_refused(tmp_path: Path) -> None:
    source, out = meshes(tmp_path / "in", "a", "b"), tmp_path / "out"
    found = list(find_assets([str(source)]))
    results = batch(out).run(found)
    next(results)
    with pytest.raises(NispError, match="expected no other nisp batch at work here"):
        ran([source], batch(out))
    results.close()
    assert len(ran([source], batch(out))) == 2


def test_shards_share_the_work_and_are_merged(tmp_path: Path) -> None:
    names = [f"a{number}" for number in range(8)]
    source, out = meshes(tmp_path / "in", *names), tmp_path / "out"
    parts = [ran([source, "nowhere"], batch(out), Shard(part, 2)) for part in (1, 2)]
    assert set(lines(out, ledger_name(Shard(2, 2)))) == set(parts[1])
    assert sorted([*parts[0], *parts[1]]) == sorted(
        [*(f"{name}.nisp" for name in names), "nowhere"]
    )
    assert "nowhere" in parts[0]
    assert not (out / "catalogue.html").exists()
    assert all(each.kept for each in ran([source], batch(out), Shard(2, 2)).values())
    records, warnings = merge(out)
    assert len(records) == 9
    assert not warnings
    assert all(each.kept for each in ran([source], batch(out)).values())


def test_options_of_an_asset_that_exclude_those_of_the_batch_are_its_problem(
    tmp_path: Path,
) -> None:
    source = meshes(tmp_path / "in", "a", "b")
    (source / "list.csv").write_text("source,target_size\na.obj,5000\nb.obj,\n")
    run = batch(tmp_path / "out")
    run.settings = run.settings.changed({"target_error": 1e-3})
    results = ran([source / "list.csv"], run)
    assert results["b.nisp"].record.done
    assert "expected one of them" in results[str(source / "a.obj")].record.error


def test_half_written_files_of_a_killed_run_are_removed(tmp_path: Path) -> None:
    for name in (".a.nisp.abcd_123", "x/.a.decoded.webp.12345678", ".catalogue.jsonl.zzzzzzzz"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).touch()
    (tmp_path / ".hidden").touch()
    remove_temporaries(tmp_path)
    assert [each.name for each in tmp_path.rglob("*") if each.is_file()] == [".hidden"]


def test_encode_many_yields_results_and_needs_no_main_guard(tmp_path: Path) -> None:
    """As a script that people would write; the fit is somebody else's."""
    source = meshes(tmp_path / "in", "a", "b")
    script = tmp_path / "script.py"
    script.write_text(
        "from nispcodec.catalogue.find import find_assets\n"
        "from tests.catalogue.stubs import batch\n"
        f"for each in batch({str(tmp_path / 'out')!r}).run(list(find_assets([{str(source)!r}]))):\n"
        "    print(each.record.output, each.record.status)\n"
    )
    root = Path(__file__).parents[2]
    run = subprocess.run(
        [sys.executable, str(script)], capture_output=True, text=True, cwd=root,
        env={"PYTHONPATH": str(root), "PATH": ""},
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    assert sorted(run.stdout.splitlines()) == ["a.nisp done", "b.nisp done"]
    kept = list(encode_many(source, tmp_path / "out", batch=BatchConfig(jobs=1, thumbnail=0)))
    assert [each.kept for each in kept] == [True, True]
    assert next(nispcodec.encode_many([source / "a.obj"], str(tmp_path / "out"))).kept


@pytest.mark.slow
def test_bytes_are_those_of_an_encode_in_this_process(tmp_path: Path) -> None:
    """By the real encoder with few steps: in a child on one core, and here on all."""
    source = tmp_path / "ball.obj"
    nispcodec.write_mesh(sphere(subdivisions=1), source)
    results = ran([source], batch(tmp_path / "out", few_steps))
    assert results["ball.nisp"].record.done
    config = nispcodec.EncodeConfig(threads=2)
    here = few_steps(nispcodec.load_mesh(source), config, lambda update: None)
    assert (tmp_path / "out" / "ball.nisp").read_bytes() == pack(here.document)
