from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.network import Network
from nispcodec.render.camera import Camera
from nispcodec.render.march import EPSILON, March
from nispcodec.render.space import Space, bounding_space
from tests import tiny

SIZE = 32


def rays(camera: Camera) -> tuple[np.ndarray, np.ndarray]:
    middles = (np.arange(SIZE) + 0.5) / SIZE
    x, y = np.meshgrid(middles, middles)
    directions = camera.directions(x.ravel(), y.ravel())
    return np.tile(camera.eye.astype(np.float32), (SIZE**2, 1)), directions


def slab(half: float) -> Network:
    """|z| - half: a plate as thin as one likes."""
    both = np.array([[0, 0, 1.0], [0, 0, -1.0]])
    return tiny.relu_network([(both, np.zeros(2)), (np.ones((1, 2)), np.array([-half]))])


@pytest.fixture(scope="module")
def ball() -> tuple[Network, Space]:
    network = tiny.sphere(0.6)
    return network, bounding_space(network)


def test_rays_hit_a_sphere_where_it_is(ball: tuple[Network, Space]) -> None:
    origins, directions = rays(Camera(40, 10))
    found = March(*ball, origins, directions).run().distances
    along = -(origins * directions).sum(axis=1)
    inner = 0.6**2 - ((origins**2).sum(axis=1) - along**2)
    clear = np.abs(inner) > 4e-3
    np.testing.assert_array_equal(np.isfinite(found)[clear], (inner > 0)[clear])
    hit = np.isfinite(found) & (inner > 0.02)
    np.testing.assert_allclose(found[hit], (along - np.sqrt(np.maximum(inner, 0)))[hit], atol=5e-3)


def test_hits_lie_on_the_fields_own_surface(ball: tuple[Network, Space]) -> None:
    from nispcodec.infer.evaluate import evaluate

    origins, directions = rays(Camera())
    found = March(*ball, origins, directions).run()
    hit = np.isfinite(found.distances)
    points = origins[hit] + found.distances[hit, None] * directions[hit]
    assert np.abs(evaluate(ball[0], points)).max() < 2 * EPSILON
    assert not found.lost.any()


def test_a_ray_that_starts_inside_finds_the_way_out(ball: tuple[Network, Space]) -> None:
    directions = np.eye(3, dtype=np.float32)
    found = March(*ball, np.zeros((3, 3), np.float32), directions, inside=True).run()
    np.testing.assert_allclose(found.distances, 0.6, atol=3e-3)


@pytest.mark.parametrize("half", [8e-3, 3e-3])
@pytest.mark.parametrize("steepness", [0.6, 1.0, 1.8])
def test_no_ray_slips_through_a_thin_plate(half: float, steepness: float) -> None:
    """Whatever the slope of the field, from too flat to almost twice too steep."""
    network = slab(half)
    network.tensors["weight.1"][:] *= steepness
    network.tensors["bias.1"][:] *= steepness
    origins, directions = rays(Camera(20, 15, fov=20))
    found = March(network, bounding_space(network), origins, directions).run().distances
    distances = (half - origins[:, 2]) / directions[:, 2]
    inside = np.linalg.norm(origins + distances[:, None] * directions, axis=1) < 0.95
    np.testing.assert_allclose(found[inside], distances[inside], atol=2e-3)


def test_a_ray_that_speeds_away_still_meets_the_wall_before_it_leaves() -> None:
    """Past one plate, along which the spheres grow, and out to another at the edge of the ball."""
    both = np.array([[0, 0, 1.0], [0, 0, -1.0]])
    # | |z| - 0.45 | - 0.05: two plates, nothing between them.
    network = tiny.relu_network(
        [
            (both, np.zeros(2)),
            (np.array([[1.0, 1.0], [-1.0, -1.0]]), np.array([-0.45, 0.45])),
            (np.ones((1, 2)), np.array([-0.05])),
        ]
    )
    x, z = np.meshgrid(np.linspace(0.4, 0.85, 20), np.linspace(0.3, 0.39, 10))
    targets = np.stack([x.ravel(), 0 * x.ravel(), 0 * x.ravel() - 0.4], axis=1)
    origins = np.stack([0 * x.ravel() - 0.85, 0 * x.ravel(), z.ravel()], axis=1)
    lengths = np.linalg.norm(targets - origins, axis=1)
    directions = ((targets - origins) / lengths[:, None]).astype(np.float32)
    march = March(network, bounding_space(network), origins.astype(np.float32), directions)
    np.testing.assert_allclose(march.run().distances, lengths, atol=5e-3)


def test_what_is_far_from_the_surface_needs_no_network(ball: tuple[Network, Space]) -> None:
    origins, directions = rays(Camera())
    found = March(*ball, origins, directions).run()
    assert (found.steps[~np.isfinite(found.distances)] == 0).mean() > 0.9
    assert found.steps.mean() < 10


def test_the_space_never_promises_too_much(ball: tuple[Network, Space]) -> None:
    points = np.random.default_rng(0).uniform(-1, 1, (20_000, 3)).astype(np.float32)
    room = np.linalg.norm(points, axis=1) - 0.6
    free = ball[1].free(points)
    assert (np.abs(free) <= np.abs(room) + 1e-3).all()
    assert (free[room > 1e-3] >= 0).all()
    assert (free[room < -1e-3] <= 0).all()
    assert (free[np.abs(room) > 0.1] != 0).all()


@pytest.mark.parametrize("height", [-EPSILON / 2, EPSILON / 2])
def test_a_ray_along_an_edge_hits_if_it_crosses_the_surface(height: float) -> None:
    """Past the corner of an octahedron, nearer to it than epsilon on either side."""
    network = tiny.octahedron(0.8)
    origin = np.array([[-3.0, 0.8 + height, 0.0]], np.float32)
    direction = np.array([[1.0, 0, 0]], np.float32)
    found = March(network, bounding_space(network), origin, direction).run().distances
    assert np.isfinite(found[0]) == (height < 0)


def test_noise_of_the_field_is_no_surface() -> None:
    """A zero set in the corner of the cube, outside the unit ball."""
    corner = np.full((1, 3), -1 / np.sqrt(3))
    network = tiny.relu_network([(corner, np.array([2.0])), (np.ones((1, 1)), np.array([-0.4]))])
    space = bounding_space(network)
    directions = np.array([[-1.0, 0, 0], [0, -1.0, 0]], np.float32)
    origins = np.array([[4, 0.99, 0.99], [0.99, 4, 0.99]], np.float32)
    assert np.isinf(March(network, space, origins, directions).run().distances).all()
