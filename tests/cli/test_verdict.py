"""`nisp compare` ends with a verdict, and says what its numbers mean."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from nispcodec_cli.columns import COLUMNS, names
from nispcodec_cli.verdict import GRADES, verdict

from nispcodec.io.save import write_mesh
from nispcodec.metrics.compare import compare
from tests.cli.conftest import done
from tests.metrics.shapes import sphere


def report(
    mean: float = 1e-4, p99: float = 1e-3, color: float = 0.01, most: float = 5e-3, pieces: int = 0
) -> dict[str, Any]:
    """What a comparison would say; `color` is a root mean square difference."""
    psnr = -20 * math.log10(color) if color else 200.0
    return {
        "geometry": {"larger": {"mean": mean, "p99": p99, "max": most}},
        "spurious": {"count": pieces, "area": 0.0},
        "color": {"psnr": psnr},
    }


def grade(**numbers: Any) -> int:
    """Which of the GRADES the verdict names."""
    text = verdict(report(**numbers))
    (found,) = [number for number, each in enumerate(GRADES) if each.words in text]
    return found


def test_the_sentence_has_the_numbers() -> None:
    assert verdict(report(mean=4e-4, p99=2e-3, color=0.01)) == (
        "The surfaces are 0.04 % of the radius apart in the mean and 0.2 % at the worst hundredth; "
        "base colors differ by 1 % (root mean square): hard to tell apart by eye."
    )


def test_the_same_is_called_the_same() -> None:
    text = verdict(report(mean=0.0, p99=0.0, color=0.0, most=0.0))
    assert text.startswith("The surfaces are the same; base colors are the same: hard to tell")


@pytest.mark.parametrize("what", ["mean", "p99", "color"])
def test_each_number_alone_can_spoil_the_verdict(what: str) -> None:
    found = [grade(**{what: value}) for value in np.geomspace(1e-5, 0.9, 40)]
    assert found == sorted(found)
    assert set(found) == {0, 1, 2, 3}


@pytest.mark.parametrize("number", range(3))
def test_a_bound_belongs_to_the_better_grade(number: int) -> None:
    each = GRADES[number]
    assert grade(mean=each.mean, p99=each.p99, color=0.999 * each.color) == number
    assert grade(mean=1.01 * each.mean) == number + 1


def test_a_lost_part_is_never_hard_to_tell() -> None:
    assert grade(most=0.2) == 2
    assert "Somewhere they are 20 % apart: look for a part" in verdict(report(most=0.2))


def test_pieces_that_float_are_never_hard_to_tell() -> None:
    assert grade(pieces=1) == 2
    assert "1 piece floats where nothing should be." in verdict(report(pieces=1))
    assert "2 pieces float where nothing should be." in verdict(report(pieces=2))


def test_the_last_line_of_a_comparison_is_the_verdict(mesh: Path) -> None:
    last = done("compare", mesh, mesh, "--samples", 500).stdout.splitlines()[-1]
    assert last.startswith("The surfaces are the same; base colors are the same: hard to tell")


def test_what_differs_is_told(mesh: Path, tmp_path: Path) -> None:
    other = tmp_path / "large.obj"
    write_mesh(sphere(subdivisions=2, radius=1.5), other)
    last = done("compare", mesh, other, "--samples", 500).stdout.splitlines()[-1]
    assert GRADES[-1].words in last


def test_json_holds_the_verdict_and_what_it_was(mesh: Path) -> None:
    found = json.loads(done("compare", mesh, mesh, "--samples", 500, "--json").stdout)
    assert found["verdict"] == verdict(found)
    assert "explained" not in found
    found = json.loads(done("compare", mesh, mesh, "--samples", 500, "--json", "--explain").stdout)
    assert found["explained"]["geometry"]["p99"] == COLUMNS["geometry"]["p99"]


def test_every_number_is_explained(model: Path, mesh: Path) -> None:
    arguments = ("compare", mesh, model, "--resolution", 16, "--samples", 500)
    found = json.loads(done(*arguments, "--json").stdout)
    del found["verdict"]
    for title, values in found.items():
        assert set(names(values)) <= set(COLUMNS[title]), title
    text = done(*arguments, "--explain").stdout
    for title, values in found.items():
        assert all(COLUMNS[title][name] in text for name in names(values))
    assert "shares of the asset's radius" in text
    assert all(each.words in text for each in GRADES[:-1])


def test_nothing_is_explained_that_is_not_there() -> None:
    mesh = sphere(subdivisions=1)
    found = compare(mesh, mesh, samples=200, model=None)
    assert set(found) < set(COLUMNS)
    known = {name for values in COLUMNS.values() for name in values}
    told = {name for values in found.values() for name in names(values)}
    assert known - told == {"accuracy"}


def test_without_asking_nothing_is_explained(mesh: Path) -> None:
    assert COLUMNS["geometry"]["p99"] not in done("compare", mesh, mesh, "--samples", 500).stdout


def test_a_model_is_judged_as_well(model: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.glb"
    done("decode", model, "-o", out, "--resolution", 48)
    last = done("compare", out, model, "--resolution", 48, "--samples", 500).stdout
    assert "of the radius apart in the mean" in last.splitlines()[-1]
