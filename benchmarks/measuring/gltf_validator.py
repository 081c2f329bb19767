"""The Khronos glTF validator, where node and its package are."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path

from benchmarks.measuring.build import HERE
from benchmarks.measuring.result_file import Record

SCRIPT = Path(__file__).with_suffix(".cjs")
PACKAGES = HERE / "build" / "node" / "node_modules"
INSTALL = "npm install --prefix build/node gltf-validator@2.0.0-dev.3.10"


def lacking() -> str | None:
    """The reason why nothing can be validated, None where it can."""
    if shutil.which("node") is None:
        return "node is not installed"
    if not (PACKAGES / "gltf-validator").is_dir():
        return f"gltf-validator is not installed: {INSTALL}"
    return None


def issues(path: Path) -> Record:
    """The validator's issues with a glTF or GLB: `numErrors`, `numWarnings`, `messages`, ..."""
    command = ["node", str(SCRIPT), str(path)]
    environment = os.environ | {"NODE_PATH": str(PACKAGES)}
    run = subprocess.run(
        command, capture_output=True, text=True, check=True, env=environment, timeout=300
    )
    found: Record = json.loads(run.stdout)
    return found
