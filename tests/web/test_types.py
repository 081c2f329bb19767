"""The JSDoc types of the modules hold, and the example of docs/web.md runs."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from nispcodec.format import pack
from tests import tiny
from tests.web.programs import HERE, WEB, node, npm_package, run_node

PAGE = HERE.parent.parent / "docs" / "web.md"


@pytest.mark.slow
def test_types_hold() -> None:
    compiler = npm_package("typescript") / "bin" / "tsc"
    npm_package("@types/three")
    command = [node(), str(compiler), "-p", str(WEB)]
    run = subprocess.run(command, capture_output=True, text=True)
    assert run.returncode == 0, run.stdout


def test_the_example_of_the_documentation_runs(tmp_path: Path) -> None:
    """But for its images, which only a browser decodes."""
    example = re.findall(r"```js\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)[0]
    lines = [line for line in example.splitlines() if "images" not in line]
    file = tmp_path / "model.nisp"
    file.write_bytes(pack(tiny.document()))
    script = "\n".join(lines).replace("./web/", f"{WEB.as_uri()}/")
    fetched = 'new Uint8Array(await (await fetch("model.nisp")).arrayBuffer())'
    assert fetched in script
    read = f'new Uint8Array((await import("node:fs")).readFileSync("{file}"))'
    (tmp_path / "example.mjs").write_text(
        script.replace(fetched, read) + "\nconsole.log(mesh.indices.length > 0);"
    )
    assert run_node(tmp_path / "example.mjs") == "true\n"
