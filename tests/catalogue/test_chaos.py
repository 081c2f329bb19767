"""Chaos in small: the loop of the benchmark, with a stub for the encoder."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.catalogue.chaos import chaos, judged
from tests.catalogue.stubs import meshes

ROOT = Path(__file__).parents[2]
DRIVER = """
import sys
from pathlib import Path
from nispcodec.catalogue.config import BatchConfig
from tests.catalogue.stubs import batch, ran, wild
source, output = map(Path, sys.argv[1:])
ran([source], batch(output, wild, BatchConfig(jobs=2, thumbnail=0, timeout=3)))
"""


@pytest.mark.slow
def test_nothing_is_lost_and_what_is_bad_is_told(tmp_path: Path) -> None:
    source = meshes(tmp_path / "in", "dies", "hangs", *(f"slow-{number}" for number in range(8)))

    def begun(output: Path) -> subprocess.Popen[bytes]:
        words = [sys.executable, "-c", DRIVER, str(source), str(output)]
        return subprocess.Popen(words, cwd=ROOT, start_new_session=True)

    assert begun(tmp_path / "quiet").wait() == 0
    what = chaos(begun, tmp_path / "out", kills=4, seed=1, grow=None)
    assert what["kills"] == 4
    found = judged(tmp_path / "quiet", tmp_path / "out")
    assert (found["good"], found["missing"], found["different"], found["unsound"]) == (8, 0, 0, 0)
    assert set(found["failed"]) == {"dies.nisp", "hangs.nisp"}
    assert found["lines"] == 10
    assert found["half_written"] == []
