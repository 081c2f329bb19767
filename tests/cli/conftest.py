from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result
from nispcodec_cli import main

import nispcodec
from nispcodec.core.document import Document
from nispcodec.core.progress import Progress
from nispcodec.format import pack
from nispcodec.io.save import write_mesh
from nispcodec.model import NispModel
from tests import tiny
from tests.metrics.shapes import sphere

Encoder = Callable[[Document | BaseException], dict[str, Any]]
"""Takes what an encode ends in, and tells later what it was asked."""

UPDATES = [
    Progress(stage="samples", overall=0.0),
    Progress("sdf", "fit", 10, 100, loss=0.5, error=1e-3, seconds_left=75, overall=0.12),
    Progress("sdf", "fit", 11, 100, loss=0.4, note="diverged at step 11, retrying", overall=0.13),
    Progress("uv", "fit", step=50, steps=100, overall=0.5),
]


@pytest.fixture
def model(tmp_path: Path) -> Path:
    """An octahedron in two charts, as a file."""
    path = tmp_path / "tiny.nisp"
    path.write_bytes(pack(tiny.document()))
    return path


@pytest.fixture
def mesh(tmp_path: Path) -> Path:
    """A textured sphere, as an OBJ."""
    path = tmp_path / "ball.obj"
    write_mesh(sphere(subdivisions=2), path)
    return path


@pytest.fixture
def encoder(monkeypatch: pytest.MonkeyPatch) -> Encoder:
    """Stand-in for the encoder: tells UPDATES, then does what the test wants.

    It gives the document, or raises; what it was asked for is in the dictionary that it returns.
    """
    seen: dict[str, Any] = {}

    def install(outcome: Document | BaseException) -> dict[str, Any]:
        def encode(mesh: Any, config: Any, progress: Any) -> NispModel:
            seen.update(mesh=mesh, config=config)
            for update in UPDATES:
                progress(update)
            if isinstance(outcome, BaseException):
                raise outcome
            return NispModel(outcome)

        monkeypatch.setattr(nispcodec, "encode", encode)
        return seen

    return install


def nisp(*arguments: object, given: bytes = b"") -> Result:
    """Run the command line in this process, with some bytes on standard input."""
    return CliRunner().invoke(main, [str(each) for each in arguments], input=given)


def done(*arguments: object, given: bytes = b"") -> Result:
    """Run it and see that all went well."""
    result = nisp(*arguments, given=given)
    assert result.exit_code == 0, result.output
    return result


def refused(result: Result, *words: str) -> None:
    """The command failed in the way the user can mend: code 2, one line on stderr, no output."""
    assert result.exit_code == 2, result.output
    assert result.stdout == ""
    (line,) = [each for each in result.stderr.splitlines() if not each.startswith("nisp: warning")]
    assert line.startswith("nisp: error: ")
    for word in words:
        assert word in line
