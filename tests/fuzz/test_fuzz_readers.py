"""The fuzzer of the readers runs, and its first files are no surprise."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.fuzz.fuzz_readers import main, seeds


def test_the_seeds_can_be_read(tmp_path: Path) -> None:
    kinds = {suffix for suffix, _ in seeds(tmp_path)}
    assert kinds == {".obj", ".mtl", ".gltf", ".glb", ".ply", ".stl", ".off"}


def test_a_few_files(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    main(["", "500", "0"])
    assert ".glb refused" in capsys.readouterr().out
    assert list(tmp_path.iterdir()) == []
