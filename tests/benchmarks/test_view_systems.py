"""SRN and NeRF, small: what they draw, that they learn, and that a seed decides everything."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import torch
from torch import Tensor

from benchmarks.paper.nerf import NerfConfig, RadianceField, fourier, opacities, stratified
from benchmarks.paper.rays import Rays, box_of, rays_of, tensor
from benchmarks.paper.srn import SceneRepresentation, SrnConfig
from benchmarks.paper.unlit import unlit_mesh
from benchmarks.paper.view_set import all_around, view_set
from benchmarks.paper.view_training import Drawer, ViewSchedule, drawn, fit_views
from nispcodec.render.camera import Camera
from nispcodec.render.views import render_views
from tests.metrics.shapes import sphere
from tests.render.scenes import square, with_maps

SIZE = 12
NERF = NerfConfig((16,) * 2, color=8, points=2, directions=1, coarse=8, fine=8)
SRN = SrnConfig((16,) * 2, (16,), marches=3)
SYSTEMS: dict[str, tuple[Callable[[], Drawer], ViewSchedule]] = {
    "nerf": (lambda: RadianceField(NERF), ViewSchedule(150, 128, 1e-2)),
    "srn": (lambda: SceneRepresentation(SRN), ViewSchedule(150, 128, 5e-3)),
}
BALL = with_maps(sphere(), base_color=[[[200, 40, 20]]])


def learned(system: str, seed: int = 0, steps: int = 150) -> tuple[Drawer, list[float]]:
    """A system fitted to a red ball, and its losses."""
    make, schedule = SYSTEMS[system]
    torch.manual_seed(seed)
    drawer = make()
    views = view_set(BALL, 6, 1, SIZE)
    rays, hit = rays_of(views.cameras, SIZE, views.box, "cpu")
    colors = tensor(views.pictures.reshape(-1, 3), "cpu")[hit]
    losses: list[float] = []
    schedule = ViewSchedule(steps, schedule.rays, schedule.rate)
    fit_views(drawer, rays, colors, schedule, seed, lambda step, loss: losses.append(loss))
    return drawer, losses


def some_rays(count: int) -> Rays:
    rays, _ = rays_of([Camera()], 16, np.array([[-0.5] * 3, [0.5] * 3]), "cpu")
    return rays[slice(0, count)]


def weights(drawer: Drawer) -> Tensor:
    return torch.cat([each.detach().flatten() for each in drawer.parameters()])


@pytest.mark.parametrize("system", SYSTEMS)
def test_a_system_learns_what_it_is_shown(system: str) -> None:
    _, losses = learned(system)
    assert np.mean(losses[-10:]) < 0.35 * np.mean(losses[:10])


@pytest.mark.parametrize("system", SYSTEMS)
def test_a_seed_decides_everything(system: str) -> None:
    (first, _), (again, _), (other, _) = (learned(system, seed, 5) for seed in (0, 0, 1))
    assert torch.equal(weights(first), weights(again))
    assert not torch.equal(weights(first), weights(other))


@pytest.mark.parametrize("system", SYSTEMS)
def test_a_ray_has_a_color_whatever_else_is_drawn(system: str) -> None:
    drawer, rays = SYSTEMS[system][0](), some_rays(20)
    colors = drawn(drawer, rays)
    assert colors.shape == (20, 3)
    assert (colors >= 0).all()
    assert (colors <= 1).all()
    torch.testing.assert_close(drawn(drawer, rays[slice(5, 9)]), colors[5:9])


def test_rays_are_cut_to_the_box_and_the_others_left_out() -> None:
    box = box_of(np.array([[-0.2, -0.3, -0.4], [0.2, 0.3, 0.4]]))
    rays, hit = rays_of([Camera(), Camera(90, 0)], SIZE, box, "cpu")
    assert hit.shape == (2 * SIZE * SIZE,)
    assert 0 < len(rays) == int(hit.sum()) < len(hit)
    for distances in (rays.near, rays.far):
        on_a_wall = (rays.at(distances)[:, 0, None] - tensor(box, "cpu")).abs().amin(dim=(1, 2))
        assert (on_a_wall < 1e-5).all()


def test_samples_lie_in_their_strata() -> None:
    rays, random = some_rays(7), torch.Generator().manual_seed(0)
    for generator in (None, random):
        distances = stratified(rays, 4, generator)
        stratum = ((distances - rays.near) / (rays.far - rays.near) * 4).floor()
        assert torch.equal(stratum, torch.arange(4.0).expand(7, 4))


def test_light_comes_from_the_first_thing_that_is_dense() -> None:
    rays = some_rays(1)
    distances = stratified(rays, 4, None)
    dense = torch.tensor([[0.0, 1e4, 1e4, 1e4]])
    torch.testing.assert_close(opacities(dense, distances, rays), torch.eye(4)[1:2])
    assert float(opacities(torch.rand(1, 4), distances, rays).sum()) < 1


def test_fourier_features_are_the_values_and_their_waves() -> None:
    found = fourier(torch.tensor([[0.5, 0.25]]), 2)
    waves = [0.5, 0.25, 1, 0.5**0.5, 0, 1, 0, 0.5**0.5, -1, 0]
    torch.testing.assert_close(found, torch.tensor([waves]), atol=1e-6, rtol=0)


def test_cameras_stand_all_around() -> None:
    eyes = np.stack([camera.eye for camera in all_around(200)])
    eyes /= np.linalg.norm(eyes, axis=1, keepdims=True)
    assert np.abs(eyes.mean(axis=0)).max() < 0.01
    assert ((eyes @ eyes.T - 2 * np.eye(200)).max(axis=1) < 0.999).all()


def test_an_unlit_square_has_the_colors_of_its_image_from_wherever_it_is_seen() -> None:
    mesh = unlit_mesh(square(base_color=[[[200, 40, 20]]]))
    for picture in render_views(mesh, [Camera(0, 0), Camera(60, 30)], 24):
        shown = picture[picture[..., 3] == 1][:, :3]
        assert len(shown) > 20
        np.testing.assert_allclose(
            shown, np.tile(np.array([200, 40, 20]) / 255, (len(shown), 1)), atol=2e-3
        )
