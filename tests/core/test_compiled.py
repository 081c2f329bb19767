from __future__ import annotations

import ctypes
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from nispcodec.core.compiled import CompiledKernel, KernelError
from nispcodec.infer.native.mesh_kernel import KERNEL


@pytest.fixture
def kernel(tmp_path: Path) -> CompiledKernel:
    """A copy of the libraries, which are loaded from there; skips where there are none."""
    if not KERNEL.available():
        pytest.skip("no kernel was built for this machine")
    for isa in KERNEL.available():
        shutil.copy(KERNEL.path(isa), tmp_path)
    return replace(KERNEL, folder=tmp_path)


def test_the_best_that_loads_is_taken(kernel: CompiledKernel) -> None:
    # Loaded before, a library stays what it was, whatever its file becomes.
    broken, *others = sorted(kernel.folder.iterdir(), reverse=True)
    broken.write_bytes(b"no library")
    if others:
        assert kernel.best()._name == str(others[0])
    else:
        with pytest.raises(KernelError, match="does not load"):
            kernel.best()


def test_without_any_the_error_says_why(tmp_path: Path) -> None:
    with pytest.raises(KernelError, match="was not built"):
        replace(KERNEL, folder=tmp_path).best()
    assert replace(KERNEL, folder=tmp_path).available() == ()


def test_one_of_another_version_is_not_used(kernel: CompiledKernel) -> None:
    with pytest.raises(KernelError, match="expected version"):
        replace(kernel, interface=kernel.interface + 1).best()


def test_one_instruction_set_may_be_asked_for(kernel: CompiledKernel) -> None:
    isa = kernel.available()[-1]
    functions = kernel.load(isa)
    assert functions.nisp_version.restype is ctypes.c_int
    with pytest.raises(KernelError, match="was not built"):
        kernel.load("v1")
