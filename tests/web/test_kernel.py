"""The committed WebAssembly is what its source compiles to."""

from __future__ import annotations

import subprocess

from tests.web.programs import WEB, node, npm_package


def test_the_kernel_is_built_from_its_source() -> None:
    npm_package("wabt")
    command = [node(), str(WEB / "tools" / "build_kernel.mjs"), "--check"]
    run = subprocess.run(command, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
