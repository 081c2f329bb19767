"""The page on physics: its Python runs as it is written, and so does its example in Warp."""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest

import nispcodec
from nispcodec.extract.decoded_distance import DecodedDistance
from nispcodec.model import NispModel
from tests import tiny
from tests.docs.pages import ROOT

PAGE = ROOT / "docs" / "physics.md"
EXAMPLE = ROOT / "docs" / "physics" / "balls.py"
WARP = Path(os.environ.get("NISPCODEC_WARP_PYTHON", ROOT / "build" / "warp" / "bin" / "python"))


def test_python_of_the_page_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    model = NispModel(tiny.document())
    nispcodec.save(model, tmp_path / "sample.nisp")
    model.sdf_grid(16, 24).save(tmp_path / "field.npz")
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.S)
    assert len(blocks) == 2
    for block in blocks:
        exec(compile(block, PAGE.name, "exec"), {})


@pytest.mark.slow
@pytest.mark.skipif(not WARP.exists(), reason="NVIDIA Warp is not installed: make warp")
def test_balls_come_to_rest_on_the_surface(tmp_path: Path) -> None:
    model = NispModel(tiny.document())
    grid = model.sdf_grid(48, 48)
    grid.save(tmp_path / "field.npz")
    command = [str(WARP), str(EXAMPLE), str(tmp_path / "field.npz"), str(tmp_path / "rest.npy")]
    run = subprocess.run(command, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    rest = np.load(tmp_path / "rest.npy")
    frame = model.document.frame
    away = DecodedDistance(model.document, 48)(frame.to_normalized(rest)) * frame.radius
    assert len(away) == 200
    assert np.abs(away - 3 * grid.spacing).max() < 0.2 * grid.spacing
