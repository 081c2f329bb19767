from __future__ import annotations

import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from nispcodec.core.compiled import LEVELS
from nispcodec.train.backend.native import library as module
from nispcodec.train.backend.native.library import NativeError, available, library

ROOT = Path(__file__).parents[4]
NATIVE = Path("nispcodec/train/backend/native")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the kernels, which are loaded from there."""
    for isa in available():
        shutil.copy(module.KERNEL.path(isa), tmp_path)
    monkeypatch.setattr(module, "KERNEL", replace(module.KERNEL, folder=tmp_path))
    return tmp_path


def test_the_best_that_loads_is_taken(folder: Path) -> None:
    # Loaded before, a library stays what it was, whatever its file becomes.
    broken, *others = sorted(folder.iterdir(), reverse=True)
    broken.write_bytes(b"no library")
    if others:
        assert f"_kernel_{library().isa}.so" == others[0].name
    else:
        with pytest.raises(NativeError, match="does not load"):
            library()


def test_without_any_the_error_says_why(folder: Path) -> None:
    for path in folder.iterdir():
        path.unlink()
    with pytest.raises(NativeError, match="was not built"):
        library()


def test_a_kernel_of_another_version_is_not_used(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    newer = replace(module.KERNEL, interface=module.KERNEL.interface + 1)
    monkeypatch.setattr(module, "KERNEL", newer)
    with pytest.raises(NativeError, match="expected version"):
        library()


def test_a_processor_without_the_instructions_takes_simpler_ones(isa: str) -> None:
    found = library(isa)
    assert found.isa == isa
    lengths = {"v2": 4, "v3": 8, "v4": 16, "neon": 4}
    assert found.functions.nisp_vector_length() == lengths[isa]
    assert isa not in LEVELS or int(isa[1:]) <= found.functions.nisp_best_level()


def test_a_compiler_that_fails_keeps_nobody_from_building(tmp_path: Path) -> None:
    shutil.copy(ROOT / "setup.py", tmp_path)
    shutil.copytree(ROOT / NATIVE / "kernel", tmp_path / NATIVE / "kernel")
    failing = {"CC": "false", "CXX": "false", "LDSHARED": "false", "LDCXXSHARED": "false"}
    built = subprocess.run(
        [sys.executable, "setup.py", "build_ext", "--inplace"],
        cwd=tmp_path,
        env=os.environ | failing,
        capture_output=True,
        text=True,
        check=False,
    )
    assert built.returncode == 0, built.stderr
    assert built.stdout.count("warning: no kernel was built") == 1
    assert not list(tmp_path.rglob("*.so"))
