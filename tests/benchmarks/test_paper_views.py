"""Table 3 of the paper, from results."""

from __future__ import annotations

import pytest

from benchmarks.measuring.result_file import Record
from benchmarks.paper import rendered_views, synthesized_views
from benchmarks.report import paper

LIKE = {"mse": 4.0, "psnr": 40.0, "ssim": 0.99}


def model(size: int, psnr: float) -> Record:
    """A model's record, as `rendered_views` keeps it."""
    unlit = {**LIKE, "psnr": psnr}
    held = "networks" if size < 6000 else "triangles"
    return {
        "bytes": {"geometry_uv": size},
        "held_as": held,
        "unlit": unlit,
        "lit": LIKE,
        "commit": "here",
    }


@pytest.fixture
def results(monkeypatch: pytest.MonkeyPatch) -> dict[str, Record]:
    systems = {
        "SRN": {"bytes": 2000, "processor_seconds": 90.0, "views": {**LIKE, "psnr": 20.0}},
        "ours": {"bytes": 9000, "geometry_uv": 4000, "views": LIKE, "commit": "there"},
    }
    rendered = {
        "fast": {name: model(3000, psnr) for name, psnr in (("a", 38.0), ("b", 40.0), ("c", 39.0))},
        "best": {"a": model(6000, 45.0), "c": model(7000, 43.0)},
    }
    found = {
        str(synthesized_views.RESULTS): {"assets": {"a": systems}},
        str(rendered_views.RESULTS): {"presets": rendered},
    }
    monkeypatch.setattr(paper, "read_result", lambda path: found[str(path)])
    return found


def test_a_published_row_stands_above_each_of_ours(results: dict[str, Record]) -> None:
    lines = paper.views().splitlines()
    assert lines[2].startswith("| SRN, published | 40.10 | 32.18 dB | 0.947 |")
    assert lines[3] == "| SRN, small | 4.00 | 20.00 dB | 0.990 | 2 kB | 1.5 min, one core |"
    assert lines[4].startswith("| NeRF, published | 17.95 |")
    assert lines[5].startswith("| ours, published | 2.95 | 43.85 dB |")
    assert "| `.nisp` | 4.00 | 40.00 dB | 0.990 | 9 kB, 4.0 without textures |" in lines[6]


def test_presets_are_averaged_over_what_all_of_them_have(results: dict[str, Record]) -> None:
    lines = paper.views().splitlines()
    assert "| a | 38.0 dB, 3.0 kB | 45.0 dB, 6.0 kB of triangles |" in lines
    assert "| b | 40.0 dB, 3.0 kB | – |" in lines
    assert "| mean of a, c | 38.5 dB, 3.0 kB | 44.0 dB, 6.5 kB |" in lines
    assert lines[-1] == "Measured at here, there."


def test_the_published_numbers_are_asked_of_every_preset(results: dict[str, Record]) -> None:
    asked = rendered_views.asked(results[str(rendered_views.RESULTS)])
    verdicts = {(each.name, each.target.name): each.verdict for each in asked}
    assert verdicts["fast", "PSNR, dB"] == "missed"
    assert verdicts["best", "PSNR, dB"] == "met"
    assert [name for name, target in verdicts if "lit" in target] == ["best"]


def test_ours_is_asked_to_be_nearer_than_what_learned_from_views(
    results: dict[str, Record],
) -> None:
    asked = synthesized_views.asked(results[str(synthesized_views.RESULTS)])
    verdicts = {each.target.name: each.verdict for each in asked}
    assert verdicts == {
        "PSNR above NeRF's, dB": "not measured",
        "PSNR above SRN's, dB": "met",
    }
