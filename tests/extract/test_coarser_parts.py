"""Levels of mesh parts keep their shape."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from nispcodec.extract.config import LevelConfig
from nispcodec.extract.meshing import textured_levels
from tests.extract.test_levels import ball
from tests.infer.parts import part_of

for package in ("meshoptimizer", "igl", "scipy"):
    pytest.importorskip(package, reason="the extra `encode` is not installed")


def test_no_vertex_is_a_spike() -> None:
    meshes, _ = textured_levels(ball(), 5)
    frame = ball().frame
    for mesh in meshes:
        radii = np.linalg.norm(frame.to_normalized(mesh.positions), axis=1)
        assert radii.max() < 0.6 + LevelConfig.reach + 1e-3


def test_a_body_does_not_pay_for_those_that_get_no_coarser() -> None:
    whole = np.asarray(trimesh.creation.icosphere(2, 0.3).triangles)
    corner = np.array([[0.5, 0, 0], [0, 0.5, 0], [0, 0, 0.5]])
    leaves = corner + np.arange(120)[:, None, None] * 1e-3
    document = replace(ball(), meshes=(part_of(np.concatenate([whole, leaves])),))
    for mesh in textured_levels(document, 3)[0]:
        points = document.frame.to_normalized(mesh.positions)
        inside = (np.linalg.norm(points, axis=1) < 0.36)[mesh.faces].all(axis=1)
        volume = abs(trimesh.Trimesh(points, mesh.faces[inside], process=False).volume)
        assert volume > 0.7 * 4 / 3 * np.pi * 0.3**3
