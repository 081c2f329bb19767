"""The programs that run JavaScript in tests; a test skips, saying why, where one is missing."""

from __future__ import annotations

import functools
import json
import shutil
import subprocess
from base64 import b64encode
from hashlib import sha256
from pathlib import Path
from typing import Any

import pytest
from nispcodec_web.bundle import bundled

HERE = Path(__file__).parent
WEB = HERE.parent.parent / "web"
OLDEST_NODE = 20


@functools.cache
def node() -> str:
    """The path of node; skips the test without one that is new enough."""
    found = shutil.which("node")
    if found is None:
        pytest.skip("node: none on the path")
    version = subprocess.run([found, "--version"], capture_output=True, text=True, check=True)
    if int(version.stdout.strip().lstrip("v").split(".")[0]) < OLDEST_NODE:
        pytest.skip(f"node: expected {OLDEST_NODE} or newer, found {version.stdout.strip()}")
    return found


def npm_package(name: str) -> Path:
    """The folder of an npm package of web/package.json; skips the test where it is missing."""
    folder = WEB / "node_modules" / name
    if not folder.is_dir():
        pytest.skip(f"{name}: not installed; `npm ci` in {WEB} does it")
    return folder


def chromium() -> str:
    """The path of Chromium; skips the test without one."""
    found = next(filter(None, map(shutil.which, ("chromium", "chromium-browser"))), None)
    if found is None:
        pytest.skip("chromium: none on the path")
    return found


def run_node(script: Path, *arguments: str | Path, timeout: float = 300) -> str:
    """What a script prints. Raises AssertionError with what it said where it fails."""
    command = [node(), str(script), *map(str, arguments)]
    run = subprocess.run(command, capture_output=True, text=True, timeout=timeout)
    assert run.returncode == 0, run.stderr
    return run.stdout


def answers(requests: list[dict[str, Any]], folder: Path) -> list[dict[str, Any]]:
    """What the decoder says to requests in node; `folder` takes a file for them."""
    path = folder / "requests.json"
    path.write_text(json.dumps(requests))
    found: list[dict[str, Any]] = json.loads(run_node(HERE / "answers.mjs", path))
    return found


def answers_in_browser(requests: list[dict[str, Any]], folder: Path) -> list[dict[str, Any]]:
    """The same in headless Chromium, in a page whose policy allows its own script alone,
    and WebAssembly but for a plain kernel."""
    npm_package("playwright-core")
    script = bundled(HERE / "answers_in_page.js")
    known = b64encode(sha256(script.encode()).digest()).decode()
    wasm = "" if requests[0]["kernel"] == "plain" else "'wasm-unsafe-eval'"
    policy = f"default-src 'none'; script-src 'sha256-{known}' {wasm}"
    head = f'<meta http-equiv="Content-Security-Policy" content="{policy}">'
    page, path = folder / "page.html", folder / "requests.json"
    page.write_text(f"<!doctype html>{head}<script>{script}</script>")
    path.write_text(json.dumps(requests))
    script_path = HERE / "answers_in_browser.mjs"
    found: list[dict[str, Any]] = json.loads(run_node(script_path, chromium(), page, path))
    return found
