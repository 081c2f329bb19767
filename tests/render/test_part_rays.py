from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("embreex", reason="rendering: extra `render`")

from nispcodec.render.part_rays import PartRays
from tests.infer.parts import cube, soup


def test_a_ray_meets_the_nearest_face_on_its_way() -> None:
    corners = np.concatenate([cube(), cube(0.2, (2, 0, 0))])
    origins = np.array([[-3, 0.1, 0.2], [0, 0.1, 0.2], [-3, 5, 0], [3, 0.05, 0.02]], np.float32)
    directions = np.array([[1, 0, 0], [2, 0, 0], [1, 0, 0], [-1, 0, 0]], np.float32)
    hits = PartRays(corners).cast(origins, directions)
    np.testing.assert_allclose(hits.distance, [2.5, 0.25, np.inf, 0.9], rtol=1e-5)
    assert hits.face[3] >= 12
    assert not hits.barycentric[2].any()


def test_weights_lead_to_the_point_that_the_ray_meets() -> None:
    corners = soup(200)
    rng = np.random.default_rng(0)
    origins, directions = rng.uniform(-1, 1, (2, 2000, 3)).astype(np.float32)
    hits = PartRays(corners).cast(origins, directions)
    met = np.isfinite(hits.distance)
    assert 0.1 < met.mean() < 0.95
    on_it = (hits.barycentric[:, :, None] * corners[hits.face]).sum(axis=1)[met]
    along = (origins + hits.distance[:, None] * directions)[met]
    np.testing.assert_allclose(on_it, along, atol=1e-5)


def test_without_triangles_or_rays_nothing_is_met() -> None:
    rays = np.zeros((3, 3), np.float32), np.ones((3, 3), np.float32)
    assert np.isinf(PartRays(np.zeros((0, 3, 3))).cast(*rays).distance).all()
    none = np.zeros((0, 3), np.float32)
    assert PartRays(cube()).cast(none, none).distance.shape == (0,)
