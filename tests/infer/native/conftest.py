"""Skips what wants the kernel, with the reason printed, where that was not built."""

from __future__ import annotations

import platform

import pytest

from nispcodec.core.compiled import LEVELS, OTHER
from nispcodec.infer.native.mesh_kernel import KERNEL


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """One test for each instruction set of such a processor."""
    if "isa" in metafunc.fixturenames:
        arm = platform.machine() in ("arm64", "aarch64")
        metafunc.parametrize("isa", [OTHER] if arm else LEVELS)


@pytest.fixture(autouse=True)
def kernel(request: pytest.FixtureRequest) -> None:
    """Skip, with a reason."""
    if "isa" in request.fixturenames:
        wanted = request.getfixturevalue("isa")
        if wanted not in KERNEL.available():
            pytest.skip(f"this machine does not run {wanted}, or it was not built")
