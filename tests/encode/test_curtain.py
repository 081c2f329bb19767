"""An open sheet in waves, in two charts: a chart network that is perfect for a moment goes on."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import nispcodec
from nispcodec import EncodeConfig, Progress, TexturedMesh
from nispcodec.encode.config import FormConfig
from tests.encode.tunings import small

ROWS, COLUMNS = 60, 75


def curtain() -> TexturedMesh:
    """9,000 faces; the left and the right half are apart in UV."""
    across, down = np.meshgrid(np.linspace(0, 1, COLUMNS + 1), np.linspace(0, 1, ROWS + 1))
    wave = 0.12 * np.sin(8 * np.pi * across)
    positions = np.stack([2 * across - 1, 2 * down - 1, wave], axis=2).reshape(-1, 3)
    grid = np.arange((ROWS + 1) * (COLUMNS + 1), dtype=np.int32).reshape(ROWS + 1, COLUMNS + 1)
    a, b, c, d = grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]
    faces = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    left = positions[faces][:, :, 0].mean(axis=1, keepdims=True) < 0
    uvs = 0.9 * np.stack([across, down], axis=2).reshape(-1, 2)
    return TexturedMesh(
        positions=positions,
        faces=faces,
        uvs=np.concatenate([uvs, uvs + np.array([0.1, 0.0])]),
        uv_faces=np.where(left, faces, faces + len(uvs)).astype(np.int32),
        face_materials=np.zeros(len(faces), np.int32),
    )


@pytest.mark.slow
def test_an_open_sheet_in_two_charts_is_fitted() -> None:
    mesh, told = curtain(), list[Progress]()

    config = EncodeConfig("fast", geometry="field")
    # Measured on a surface as fine as sheets need.
    tuning = replace(small(20_000, 1500, 2, 500, 300, lambda_=1e-6), forms=FormConfig())
    info = nispcodec.encode(mesh, config, told.append, tuning).document.info
    assert len(mesh.faces) == 9000
    assert not any(update.warning and update.network for update in told)
    assert not any("diverged" in update.note for update in told)
    assert float(info["open_surface_share"]) == 1
    assert float(info["chart_accuracy"]) > 0.97
    assert float(info["distance_error"]) < 0.005
