"""The committed WebAssembly is what its source compiles to."""

from __future__ import annotations

import subprocess
import sys

from tests.web.programs import WEB, node, npm_package


def test_the_kernel_is_built_from_its_source() -> None:
    npm_package("wabt")
    command = [node(), str(WEB / "tools" / "build_kernel.mjs"), "--check"]
    run = subprocess.run(command, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr


def test_the_decoder_of_meshes_is_built_from_its_source() -> None:
    node()
    npm_package("assemblyscript")
    command = [sys.executable, str(WEB / "tools" / "build_mesh.py"), "--check"]
    run = subprocess.run(command, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
