"""Skips what wants the kernel, with the reason printed, where that was not built."""

from __future__ import annotations

import platform
from collections.abc import Iterator

import pytest
import torch

from nispcodec.core.compiled import LEVELS, OTHER
from nispcodec.train.backend.native.library import NativeError, available, library


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """One test for each instruction set of such a processor."""
    if "isa" in metafunc.fixturenames:
        arm = platform.machine() in ("arm64", "aarch64")
        metafunc.parametrize("isa", [OTHER] if arm else LEVELS)


@pytest.fixture(autouse=True)
def kernel(request: pytest.FixtureRequest) -> None:
    """Skip, with a reason."""
    try:
        library()
    except NativeError as why:
        pytest.skip(str(why))
    if "isa" in request.fixturenames:
        wanted = request.getfixturevalue("isa")
        if wanted not in available():
            pytest.skip(f"this machine does not run {wanted}, or it was not built")


@pytest.fixture(autouse=True)
def one_thread_of_torch() -> Iterator[None]:
    """For such small networks its threads cost more time than they save."""
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    yield
    torch.set_num_threads(before)
