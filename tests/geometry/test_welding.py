"""Corners are the same where their numbers are, however a file has split them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.core.asset import Material
from nispcodec.geometry.welding import welded
from tests.geometry.shapes import box_asset


def test_corners_are_welded_by_position_and_by_uv() -> None:
    mesh = box_asset()
    assert len(np.unique(welded(mesh).positions)) == 8
    both = np.concatenate([mesh.corners, mesh.corner_uvs], axis=2).reshape(-1, 5)
    assert len(np.unique(welded(mesh).corners)) == len(np.unique(both, axis=0))


def test_split_vertices_change_nothing() -> None:
    mesh = box_asset()
    faces = np.arange(mesh.faces.size, dtype=np.int32).reshape(-1, 3)
    split = welded(replace(mesh, positions=mesh.corners.reshape(-1, 3), faces=faces))
    for name, same in vars(welded(mesh)).items():
        assert np.array_equal(getattr(split, name), same), name


def test_patches_end_at_materials_and_seams() -> None:
    mesh = replace(box_asset(), face_materials=np.zeros(12, dtype=np.int32))
    assert welded(mesh).patches.max() + 1 == 6
    halves = replace(
        mesh, face_materials=np.arange(12, dtype=np.int32) % 2, materials=(Material(),) * 2
    )
    assert welded(halves).patches.max() + 1 == 12
