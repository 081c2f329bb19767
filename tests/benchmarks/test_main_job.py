from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from benchmarks.headline import main_job
from benchmarks.headline.main_job import main, table, targets
from benchmarks.measuring.machine import commit, machine, versions
from benchmarks.measuring.process import run
from benchmarks.measuring.result_file import Record
from benchmarks.measuring.target import Target

RECORD: Record = {
    "encode": {"seconds": 100.0, "peak_bytes": 10**9},
    "bytes": {"geometry_uv": 50_000},
    "made_up_share": 0.0,
    "metrics": {
        "geometry": {"larger": {"mean": 4e-4}},
        "uv": {"larger": {"median": 4e-4}},
        "spurious": {"count": 0},
        "charts": {"accuracy": 0.98},
    },
}


def test_peak_memory_counts_children(tmp_path: Path) -> None:
    child = "import time; x = bytearray(150 * 2**20); time.sleep(1)"
    parent = f"import subprocess, sys; subprocess.run([sys.executable, '-c', {child!r}])"
    done = run([sys.executable, "-c", parent], tmp_path)
    assert 150 * 2**20 < done.peak_bytes < 400 * 2**20
    assert done.seconds >= 1


def test_failed_command_tells_its_last_words(tmp_path: Path) -> None:
    code = "import sys; sys.stderr.write('out of cheese'); sys.exit(3)"
    with pytest.raises(RuntimeError, match="exit 3: out of cheese"):
        run([sys.executable, "-c", code], tmp_path)


def test_targets_depend_on_the_asset() -> None:
    limits = {name: {t.name: t.limit for t in targets(name)} for name in ("spot", "gz_polaris")}
    assert limits["spot"]["mean distance"] == 5e-4
    assert limits["gz_polaris"]["mean distance"] == 1.5e-3
    assert limits["gz_polaris"]["geometry+UV, bytes"] == 90e3
    assert "chart accuracy" in limits["spot"]
    assert "chart accuracy" not in limits["gz_polaris"]


def test_target_directions() -> None:
    assert Target("", ("metrics", "charts", "accuracy"), 0.97, at_least=True).met(RECORD)
    assert not Target("", ("metrics", "charts", "accuracy"), 0.99, at_least=True).met(RECORD)
    assert Target("", ("encode", "seconds"), 100).met(RECORD)


def test_table_marks_what_is_missed_and_what_failed() -> None:
    lines = table({"spot": RECORD, "bad": {"failure": "RuntimeError: no"}}).splitlines()
    missed = [line for line in lines if line.endswith("MISSED")]
    assert ["bytes" in missed[0], "accuracy" in missed[1], len(missed)] == [True, True, 2]
    assert lines[-1].startswith("bad")
    assert "FAILED: RuntimeError: no" in lines[-1]


def test_an_asset_without_uvs_has_no_uv_error() -> None:
    metrics = {name: each for name, each in RECORD["metrics"].items() if name != "uv"}
    (line,) = (
        each
        for each in table({"bare": {**RECORD, "metrics": metrics}}).splitlines()
        if "UV error" in each
    )
    assert line.endswith("not measured")


def test_one_failure_does_not_stop_the_rest_and_results_are_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("alpha", "beta"):
        (tmp_path / name).mkdir()
        (tmp_path / name / f"{name}.obj").write_text("")
    seen = []

    def measure(source: Path, folder: Path, preset: str, seed: int) -> Record:
        seen.append(source.stem)
        if source.stem == "alpha" and len(seen) == 1:
            raise RuntimeError("no luck")
        return RECORD

    monkeypatch.setattr(main_job, "measure", measure)
    out = tmp_path / "results" / "r.json"
    arguments = ["--assets", str(tmp_path), "-o", str(out)]
    assert CliRunner().invoke(main, arguments).exit_code == 0
    kept = json.loads(out.read_text())["assets"]
    assert "no luck" in kept["alpha"]["failure"]
    assert kept["beta"] == RECORD
    CliRunner().invoke(main, arguments)
    assert seen == ["alpha", "beta", "alpha"]
    CliRunner().invoke(main, [*arguments, "--again", "--only", "beta"])
    assert seen[3:] == ["beta"]
    CliRunner().invoke(main, [*arguments, "--seed", "2", "--only", "beta"])
    assert seen[4:] == ["beta"]
    assert json.loads(out.read_text()).keys() >= {"assets", "seeds"}
    assert json.loads(out.read_text())["seeds"] == {"2": {"beta": RECORD}}


def test_machine_is_described() -> None:
    assert int(machine()["cores"]) >= 1
    assert "torch" in versions()
    assert commit()
