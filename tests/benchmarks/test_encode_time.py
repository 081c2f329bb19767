"""Two builds by turns: stubs stand for the encoders, so that no network is fitted."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from benchmarks.headline.encode_time import asked, chosen, main
from benchmarks.headline.encode_time_table import mean, ratio, summary, tables, typical
from benchmarks.headline.encode_time_turn import Turn, picked, turns
from benchmarks.measuring.build import build_at
from benchmarks.measuring.process import run
from benchmarks.measuring.result_file import Record
from nispcodec.io.save import write_mesh
from tests.metrics.shapes import sphere

NISP = """
import json, shutil, sys
from pathlib import Path
from nispcodec import NAME

def main():
    what, source, output = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[sys.argv.index("-o") + 1])
    with (Path(__file__).parent / "calls").open("a") as calls:
        print(*sys.argv[1:], file=calls)
    if what == "decode":
        shutil.copy(Path(__file__).parent / "decoded.glb", output)
        return
    if (source.parent / "broken").exists():
        sys.exit("out of cheese")
    output.write_text(NAME)
    print(json.dumps({"bytes": {"geometry_uv": len(NAME)}}))
"""


def git(tree: Path, *arguments: str) -> None:
    who = ["-c", "user.name=nobody", "-c", "user.email=nobody@example.org"]
    subprocess.run(["git", "-C", str(tree), *who, *arguments], check=True, capture_output=True)


def stub(tree: Path, name: str, radius: float) -> Path:
    """A tree whose `nisp` writes its name in place of a model, and decodes it to a sphere."""
    for folder in ("nispcodec", "cli"):
        (tree / folder).mkdir(parents=True)
    (tree / "nispcodec" / "__init__.py").write_text(f"NAME = {name!r}\n")
    (tree / "cli" / "__init__.py").write_text(NISP)
    (tree / ".gitignore").write_text("__pycache__\ncalls\n")
    write_mesh(sphere(radius), tree / "cli" / "decoded.glb")
    git(tree, "init", "-q")
    git(tree, "add", ".")
    git(tree, "commit", "-qm", name)
    return tree


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Two builds and an asset, which the new build decodes more exactly, to fewer bytes."""
    monkeypatch.setattr("benchmarks.assets.source.SAMPLES", 4000)
    stub(tmp_path / "old", "elder", 1.2)
    stub(tmp_path / "new", "kid", 1.1)
    (tmp_path / "assets" / "ball").mkdir(parents=True)
    write_mesh(sphere(), tmp_path / "assets" / "ball" / "ball.obj")
    return tmp_path


def bench(place: Path, *options: str) -> Result:
    builds = ["--old", str(place / "old"), "--new", str(place / "new")]
    files = ["--assets", str(place / "assets"), "-o", str(place / "found.json")]
    return CliRunner().invoke(main, [*builds, *files, *options])


def calls(place: Path, build: str) -> list[str]:
    path = place / build / "cli" / "calls"
    return [line.split()[0] for line in path.read_text().splitlines()] if path.exists() else []


def test_a_tree_s_nisp_runs_with_the_tree_s_sources(place: Path) -> None:
    for name, answer in (("old", "elder"), ("new", "kid")):
        build = build_at(place / name)
        model = place / "model"
        done = run([*build.command, "encode", "x.obj", "-o", model], place, build.environment)
        assert model.read_text() == answer
        assert json.loads(done.stdout)["bytes"]["geometry_uv"] == len(answer)


def test_a_tree_without_sources_does_not_run_with_others(place: Path) -> None:
    (place / "old" / "nispcodec" / "__init__.py").unlink()
    (place / "old" / "nispcodec").rename(place / "old" / "gone")
    build = build_at(place / "old")
    with pytest.raises(RuntimeError, match="nispcodec: expected below"):
        run([*build.command, "encode", "x.obj", "-o", "y"], place, build.environment)


def test_a_build_may_be_an_environment(tmp_path: Path) -> None:
    programs = tmp_path / "env" / "bin"
    programs.mkdir(parents=True)
    (programs / "python").symlink_to(sys.executable)
    with pytest.raises(FileNotFoundError, match="bin/nisp: expected"):
        build_at(programs / "python")
    (programs / "nisp").touch()
    assert build_at(programs / "python").command == (str(programs / "nisp"),)
    assert build_at(programs / "python").name == f"installed in {tmp_path / 'env'}"


def test_a_folder_that_is_no_tree_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="expected a file of a build"):
        build_at(tmp_path)


def test_both_builds_are_measured_once_by_one_ruler(place: Path) -> None:
    done = bench(place, "--rounds", "2")
    assert done.exit_code == 0, done.output
    found = json.loads((place / "found.json").read_text())
    order = [(each["round"], each["build"]) for each in found["runs"]]
    assert order == [(0, "old"), (0, "new"), (1, "old"), (1, "new")]
    assert [each["bytes"] for each in found["runs"]] == [5, 3, 5, 3]
    distances = [each["errors"]["distance"] for each in found["runs"]]
    assert distances[0] == distances[2] == pytest.approx(0.2, rel=0.05)
    assert distances[1] == distances[3] == pytest.approx(0.1, rel=0.05)
    assert all(each["seconds"] > 0 and each["peak_bytes"] >= 0 for each in found["runs"])
    assert found["commit"] != found["old_commit"]
    # The second round's bytes are the first's: they need not be decoded and judged again.
    assert calls(place, "old") == calls(place, "new") == ["encode", "decode", "encode"]
    assert "| geometric mean |" in done.output
    bench(place, "--rounds", "2")
    assert len(calls(place, "old")) == 3
    bench(place, "--rounds", "2", "--again")
    assert len(calls(place, "old")) == 6


def test_a_failure_is_kept_and_tried_again(place: Path) -> None:
    broken = place / "assets" / "ball" / "broken"
    broken.touch()
    done = bench(place, "--rounds", "1")
    assert done.exit_code == 0
    assert "out of cheese" in done.output
    broken.unlink()
    bench(place, "--rounds", "1")
    runs = json.loads((place / "found.json").read_text())["runs"]
    assert [each["build"] for each in runs] == ["old", "new"]
    assert not any("failure" in each for each in runs)


def test_results_of_another_build_are_not_gone_on_with(place: Path) -> None:
    bench(place, "--rounds", "1")
    git(place / "new", "commit", "--allow-empty", "-qm", "later")
    done = bench(place, "--rounds", "1")
    assert done.exit_code == 1
    assert "commit: expected" in done.output
    assert bench(place, "--rounds", "1", "--again").exit_code == 0


def test_the_table_needs_no_build(place: Path) -> None:
    bench(place, "--rounds", "1")
    options = ["--table", "-o", str(place / "found.json")]
    assert "| ball |" in CliRunner().invoke(main, options).output
    without = CliRunner().invoke(main, ["-o", str(place / "found.json")])
    assert "--old: expected the older build" in without.output


def test_builds_take_turns_in_being_first() -> None:
    plan = list(turns(["a", "b"], ["fast"], 1, 2))
    assert [(each.asset, each.round, each.build) for each in plan] == [
        ("a", 0, "old"), ("a", 0, "new"), ("b", 0, "new"), ("b", 0, "old"),
        ("a", 1, "new"), ("a", 1, "old"), ("b", 1, "old"), ("b", 1, "new"),
    ]  # fmt: skip
    assert len(list(turns(["a"], ["fast", "best"], 3, 2))) == 2 * 2 * 3 * 2


def test_a_failure_is_not_done() -> None:
    turn = Turn("a", "fast", 0, 0, "old")
    assert turn.done([vars(turn) | {"bytes": 3}])
    assert not turn.done([vars(turn) | {"failure": "no luck"}])
    assert not turn.done([vars(turn) | {"seed": 1}])


def test_an_asset_without_uvs_has_none_to_compare() -> None:
    geometry = {"geometry": {"larger": {"mean": 1e-3}}, "color": {"psnr": float("inf")}}
    assert picked(geometry) == {"distance": 1e-3}
    whole = geometry | {"uv": {"larger": {"median": 1.0, "mean": 2.0}}, "color": {"psnr": 40.0}}
    assert picked(whole)["color"] == pytest.approx(0.01)


def test_assets_are_those_asked_for_or_the_eight_or_all(tmp_path: Path) -> None:
    for name in ("spot", "boombox", "other"):
        (tmp_path / name).mkdir()
        (tmp_path / name / f"{name}.obj").touch()
    assert list(chosen(tmp_path, [])) == ["boombox", "spot"]
    assert list(chosen(tmp_path, ["other"])) == ["other"]
    assert list(chosen(tmp_path / "other", [])) == ["other"]
    with pytest.raises(Exception, match="expected mug"):
        chosen(tmp_path, ["mug"])


def runs_of(
    asset: str, preset: str, old: list[float], new: list[float], seed: int = 0
) -> list[Record]:
    """Runs with these seconds, one a round; the new build's errors are half of the old one's."""
    where = {"asset": asset, "preset": preset, "seed": seed}
    return [
        {
            **where,
            "round": turn,
            "build": build,
            "seconds": each,
            "cpu_seconds": 2 * each,
            "bytes": 1000,
            "peak_bytes": 400_000_000,
            "errors": {"distance": 1e-3 if build == "old" else 5e-4},
        }
        for build, seconds in (("old", old), ("new", new))
        for turn, each in enumerate(seconds)
    ]


def test_rounds_give_a_median_and_seeds_a_mean() -> None:
    assert typical({(0, 0): 1.0, (0, 1): 2.0, (0, 2): 90.0}) == 2.0
    assert typical({(0, 0): 2.0, (1, 0): 8.0}) == pytest.approx(4)
    assert typical({}) is None


def test_a_ratio_has_the_spread_of_its_pairs() -> None:
    runs = runs_of("a", "fast", [10, 10, 20], [2, 3, 3])
    found = ratio(runs, "a", "fast", "seconds")
    assert found is not None
    assert (found.value, str(found)) == (0.3, "0.30 (0.15 to 0.30)")
    assert ratio(runs, "a", "fast", "uv_mean") is None
    unpaired = ratio(runs[:4], "a", "fast", "seconds")
    assert unpaired is not None
    assert str(unpaired) == "0.20"


def test_the_mean_over_assets_is_geometric_and_spreads_by_round() -> None:
    runs = runs_of("a", "fast", [10, 10], [1, 2]) + runs_of("b", "fast", [10, 10], [4, 2])
    found = [ratio(runs, name, "fast", "seconds") for name in "ab"]
    assert all(found)
    whole = mean([each for each in found if each])
    assert list(whole.pairs.values()) == pytest.approx([0.2, 0.2])
    assert whole.value == pytest.approx((0.15 * 0.3) ** 0.5)


def test_the_summary_is_what_targets_are_asked_of() -> None:
    runs = runs_of("a", "balanced", [10], [2]) + runs_of("b", "balanced", [10], [5])
    found = summary(runs)["balanced"]
    assert found["ratios"]["seconds"] == pytest.approx({"mean": 0.1**0.5, "worst": 0.5})
    assert found["new_seconds"] == pytest.approx({"a": 2, "b": 5})
    assert found["largest_peak_bytes"] == 400_000_000
    verdicts = {each.target.name: each.verdict for each in asked({"runs": runs})}
    assert verdicts["time, the worst asset"] == "missed"
    assert verdicts["distance, new / old"] == "met"
    assert verdicts["median UV error"] == "not measured"
    assert not any(name.startswith("fast") for name in verdicts)


def test_the_table_shows_seconds_ratios_the_worst_and_what_failed() -> None:
    failed = {"asset": "c", "preset": "best", "seed": 0, "round": 0, "build": "new"}
    runs = [
        *runs_of("a", "balanced", [10], [2]),
        *runs_of("b", "balanced", [20], [10]),
        *runs_of("a", "best", [60], [8]),
        failed | {"failure": "RuntimeError: no"},
    ]
    lines = tables(runs).splitlines()
    assert "| a | 10.0 | 2.0 | 0.20 | 0.20 | 1.00 | 1.00 | 0.50 | – | – | – |" in lines
    assert "| geometric mean | | | 0.32 | 0.32 | 1.00 | 1.00 | 0.50 | – | – | – |" in lines
    assert next(line for line in lines if "worst" in line).startswith("| worst | | | 0.50 b |")
    assert "best of the new build / balanced of the old: 0.80 of the time" in lines
    assert lines[-1] == "FAILED: c best, seed 0, new: RuntimeError: no"
    assert tables([]) == ""
