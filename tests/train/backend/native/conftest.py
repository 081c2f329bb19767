"""Skips what wants the kernel, with the reason printed, where that was not built."""

from __future__ import annotations

import pytest

from nispcodec.train.backend.native.library import LEVELS, OTHER, NativeError, available, library


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """One test for each instruction set."""
    if "isa" in metafunc.fixturenames:
        metafunc.parametrize("isa", (*LEVELS, OTHER))


@pytest.fixture(autouse=True)
def kernel(request: pytest.FixtureRequest) -> None:
    """Skip, with a reason."""
    if "without_kernel" in request.keywords:
        return
    try:
        library()
    except NativeError as why:
        pytest.skip(str(why))
    if "isa" in request.fixturenames:
        wanted = request.getfixturevalue("isa")
        if wanted not in available():
            pytest.skip(f"this machine does not run {wanted}, or it was not built")
