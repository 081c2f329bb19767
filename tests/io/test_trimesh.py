"""An independent reader, trimesh, opens what we write and sees the same asset."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

from nispcodec.io.save import write_mesh
from nispcodec.model import NispModel
from tests import tiny


@pytest.mark.parametrize("suffix", [".glb", ".obj", ".ply", ".stl"])
def test_trimesh_reads_it(tmp_path: Path, suffix: str) -> None:
    mesh = NispModel(tiny.document()).to_mesh(24)
    write_mesh(mesh, tmp_path / f"a{suffix}")
    scene = trimesh.load_scene(tmp_path / f"a{suffix}")
    read = list(scene.geometry.values())
    assert sum(len(part.faces) for part in read) == len(mesh.faces)
    assert np.allclose(scene.bounds, [mesh.positions.min(axis=0), mesh.positions.max(axis=0)])
    a, b, c = np.moveaxis(mesh.corners, 1, 0)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    assert sum(part.area for part in read) == pytest.approx(area.sum() / 2, rel=1e-4)
    if suffix in (".glb", ".obj"):
        assert all(part.visual.uv is not None for part in read)
