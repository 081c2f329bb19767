"""The fuzzer of mesh parts runs, and its seeds are valid."""

from __future__ import annotations

import pytest

from nispcodec.format.mesh import decode
from tests.fuzz import fuzz_mesh


def test_seeds_are_valid() -> None:
    assert [len(decode(seed)) for seed in fuzz_mesh.seeds()] == [1, 1, 1, 3, 1, 1]


def test_some_runs(capsys: pytest.CaptureFixture[str]) -> None:
    fuzz_mesh.main(["fuzz_mesh", "-runs=300", "-seed=1"])
    assert capsys.readouterr().out.startswith("300 runs")
