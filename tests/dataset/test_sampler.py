"""Samples: where they lie and what they are labeled with."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.dataset.config import SamplingConfig
from nispcodec.dataset.recipes import paper_training_sets
from nispcodec.geometry.analysis import normalizing_frame
from nispcodec.geometry.config import GeometryConfig, SolidConfig
from nispcodec.geometry.surface_points import barycentric
from tests.geometry.shapes import box_asset, cube, hemisphere, soup
from tests.samplers import analysis_of, sampler_of


def test_the_frame_is_centered_and_of_radius_one() -> None:
    frame = normalizing_frame(soup(hemisphere() * 3 + [5, 6, 7]))
    assert frame.center == pytest.approx((5, 6, 8.5))
    assert frame.radius == pytest.approx(np.hypot(3, 1.5))


def test_the_papers_sampler_and_the_direct_one_agree() -> None:
    """Distance histograms of the importance sampler and of displaced surface points."""
    sampler = sampler_of(box_asset(), seed=0)
    bins = np.array([0, 0.25, 0.5, 1, 1.5, 2, 3]) / SamplingConfig.beta
    count = 20_000
    reference, direct = (
        sampler.importance(count),
        sampler.near_surface(count, 1 / SamplingConfig.beta),
    )
    shares = [np.histogram(np.abs(s.sdf), bins)[0] / len(s) for s in (reference, direct)]
    assert np.abs(shares[0] - shares[1]).max() < 0.025
    inside = [(s.sdf < 0).mean() for s in (reference, direct)]
    assert inside[0] == pytest.approx(inside[1], abs=0.03)


def test_the_papers_sdf_sees_empty_space_too() -> None:
    config = SamplingConfig(paper_count=2000)
    sets = paper_training_sets(sampler_of(box_asset(), config=config))
    assert (sets.distance.sdf > 0.3).sum() > 2000
    assert len(sets.charts) == len(sets.uvs) == 2000
    assert (sets.charts.sdf < 0.3).all()


def test_labels_of_the_box() -> None:
    sampler = sampler_of(box_asset(), seed=0)
    side = sampler.analysis.frame.to_normalized(np.array([[1.2, 0.0, 0.5], [-1.5, 0.25, 0.0]]))
    labels = sampler.analysis.label(side)
    assert labels.sdf == pytest.approx(np.array([0.2, 0.5]) / sampler.analysis.frame.radius)
    uv = labels.uv * sampler.analysis.table.uv_scale + sampler.analysis.table.uv_offset
    assert labels.chart.tolist() == [1, 0]
    assert uv[0] == pytest.approx([(0.5 * 0.9 + 1) / 3, 0.75 * 0.9 / 2], abs=1e-6)
    assert uv[1] == pytest.approx([0.625 * 0.9 / 3, 0.5 * 0.9 / 2], abs=1e-6)


def test_samples_of_sheets_lie_where_their_thickness_ends_and_tell_the_sides() -> None:
    front = np.array([[[-1, -1, 0], [1, -1, 0], [1, 1, 0]], [[-1, -1, 0], [1, 1, 0], [-1, 1, 0]]])
    one = sampler_of(soup(front.astype(float)), seed=0).surface(500)
    assert np.abs(one.points[:, 2]) == pytest.approx(SolidConfig.half_thickness)
    assert (one.points[:, 2] > 0).mean() == pytest.approx(0.5, abs=0.1)
    uvs = np.concatenate([np.full((2, 3, 2), 0.2), np.full((2, 3, 2), 0.7)])
    both = sampler_of(soup(np.concatenate([front, front[:, ::-1]]).astype(float), uvs), seed=0)
    samples = both.near_surface(500, 0.05)
    uv = samples.uv * both.analysis.table.uv_scale + both.analysis.table.uv_offset
    assert uv[:, 0] == pytest.approx(np.where(samples.points[:, 2] > 0, 0.2, 0.7), abs=1e-6)


def test_every_uv_target_is_in_the_unit_square() -> None:
    sampler = sampler_of(box_asset(), seed=0)
    uv = sampler.surface(2000).uv
    assert uv.min() >= 0
    assert uv.max() <= 1


@pytest.mark.parametrize(
    ("low", "high", "offset", "scale"),
    [
        (0.0, 1.0, 0.0, 1.0),
        (0.02, 0.98, 0.0, 1.0),
        (0.1, 0.9, 0.1, 0.8),
        (-0.01, 0.99, -0.01, 1.0),
        (0.01, 1.01, 0.01, 1.0),
    ],
)
def test_uvs_that_fill_the_unit_square_need_no_map(
    low: float, high: float, offset: float, scale: float
) -> None:
    triangles = cube((0, 0, 0), 1.0)
    uvs = low + (high - low) * triangles[..., :2]
    table = analysis_of(soup(triangles, uvs)).table
    assert table.uv_offset == pytest.approx((offset, offset))
    assert table.uv_scale == pytest.approx((scale, scale))


def test_the_same_seed_gives_the_same_samples_and_another_other_ones() -> None:
    draws = [sampler_of(box_asset(), seed).near_surface(50, 0.01).points for seed in (3, 3, 4)]
    assert np.array_equal(draws[0], draws[1])
    assert not np.array_equal(draws[0], draws[2])


def test_cube_samples_fill_the_cube() -> None:
    points = sampler_of(box_asset(), seed=0).cube(4000).points
    assert np.abs(points).max() <= GeometryConfig.cube
    assert np.abs(points).max(axis=0) == pytest.approx([GeometryConfig.cube] * 3, rel=0.01)


def test_the_surface_is_sampled_by_area() -> None:
    chart = sampler_of(box_asset(), seed=0).surface(12_000).chart
    assert np.bincount(chart) / 12_000 == pytest.approx(np.full(6, 1 / 6), abs=0.02)


def test_patches_too_small_to_have_many_samples_get_those_that_they_lack() -> None:
    large, small = cube((-1, -1, -1), 2.0), cube((2, 0, 0), 0.1)
    sampler = sampler_of(soup(np.concatenate([large, small])), seed=0)
    lacking = 100 - 1000 / (1 + 20**2)
    samples = sampler.undersampled_charts(100, 1000, 1e-3)
    assert len(samples) == round(lacking)
    assert set(samples.chart) == {1}
    assert np.abs(samples.sdf).max() < 0.02
    assert len(sampler.undersampled_charts(2, 1000, 1e-3)) == 0


def test_thin_parts_get_samples_of_their_own() -> None:
    body, plate = cube((-1, -1, -1), 2.0), cube((0, 0, 0), 1.0) * [1, 1, 0.004] + [1.5, 0, 0]
    sampler = sampler_of(soup(np.concatenate([body, plate])), seed=0)
    share = 2 / (24 + 2)
    samples = sampler.thin_walls(4000, 5, 1e-3)
    x = sampler.analysis.frame.to_world(samples.points.astype(np.float64))[:, 0]
    assert len(samples) == pytest.approx(5 * share * 4000, rel=0.2)
    assert (x > 1.4).mean() > 0.9
    assert (samples.sdf < 0).mean() > 0.1
    assert len(sampler.thin_walls(1000, 100, 1e-3)) <= 1000


def test_a_body_without_thin_parts_gets_none() -> None:
    found = sampler_of(box_asset(), seed=0).thin_walls(4000, 5, 1e-3)
    assert len(found) < 0.01 * 5 * 4000, "edges alone"


def test_barycentric_coordinates_rebuild_the_point() -> None:
    random = np.random.default_rng(0)
    triangles = random.normal(size=(40, 3, 3))
    weights = random.dirichlet(np.ones(3), 40)
    points = np.einsum("nc,ncx->nx", weights, triangles)
    assert barycentric(triangles, points) == pytest.approx(weights)


def test_nearer_sets_are_spread_as_sets_of_their_own_are() -> None:
    sampler = sampler_of(box_asset(), seed=0)
    wide, near = sampler.near_and_nearer(9000, 0.02, [(8000, 0.005)])
    own = sampler.near_surface(8000, 0.005, signed=False)
    assert len(wide) <= 9000
    assert (wide.sdf < 0).mean() == pytest.approx(0.5, abs=0.1)
    assert near.sdf.min() >= 0
    assert near.sdf.mean() == pytest.approx(own.sdf.mean(), rel=0.05)
    assert np.bincount(near.chart) / 8000 == pytest.approx(np.bincount(own.chart) / 8000, abs=0.02)
    again = sampler.analysis.label(near.points.astype(np.float64), signed=False)
    assert near.sdf == pytest.approx(again.sdf, abs=1e-6)
    assert (near.chart == again.chart).mean() > 0.995


def test_a_set_that_is_not_nearer_is_drawn_by_itself() -> None:
    wide = sampler_of(box_asset(), seed=0).near_and_nearer(500, 0.005, [(400, 0.05)])[1]
    assert wide.sdf.mean() > 0.02
