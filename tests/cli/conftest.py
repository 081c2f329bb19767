from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner, Result
from nispcodec_cli import main

from nispcodec.format import pack
from nispcodec.io.save import write_mesh
from tests import tiny
from tests.metrics.shapes import sphere


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


def nisp(*arguments: object) -> Result:
    """Run the command line in this process."""
    return CliRunner().invoke(main, [str(each) for each in arguments])
