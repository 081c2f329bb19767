"""Extraction of surfaces with known answers."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.network import Network
from nispcodec.extract.components import components, spurious, without, without_noise
from nispcodec.extract.grid import CUBE
from nispcodec.extract.isosurface import Surface, extract
from nispcodec.infer.evaluate import evaluate
from tests import tiny
from tests.extract.surfaces import areas, assert_closed, assert_sound


@pytest.fixture(scope="module")
def ball() -> Network:
    return tiny.sphere()


@pytest.mark.parametrize("resolution", [8, 30, 64, 101])
def test_sphere_is_sound_and_on_the_zero_set(ball: Network, resolution: int) -> None:
    surface = extract(ball, resolution)
    assert_sound(surface.positions, surface.faces)
    assert np.abs(evaluate(ball, surface.positions)).max() < 1e-4
    assert components(surface)[0] == 1
    expected = 4 * np.pi * 0.6**2
    assert areas(surface.positions, surface.faces).sum() == pytest.approx(
        expected, rel=3 / resolution**2 + 1e-3
    )


def test_octahedron_is_sound_at_its_edges_and_corners() -> None:
    # Corners of the octahedron fall on grid points: crossings with several edges at one place.
    surface = extract(tiny.octahedron(CUBE / 2), 64)
    assert_sound(surface.positions, surface.faces)
    assert components(surface)[0] == 1


def test_faces_look_outwards(ball: Network) -> None:
    surface = extract(ball, 32)
    a, b, c = surface.positions[surface.faces].transpose(1, 0, 2)
    assert (np.einsum("ij,ij->i", np.cross(b - a, c - a), a + b + c) > 0).all()


def test_blocks_give_the_same_surface_as_the_full_grid(ball: Network) -> None:
    count = 40
    axis = (np.arange(count + 1) * (2 * CUBE / count) - CUBE).astype(np.float32)
    grid = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 3)
    inside = (evaluate(ball, grid) < 0).reshape((count + 1,) * 3)
    crossed = sum(int(np.diff(inside, axis=axis).sum()) for axis in range(3))
    assert len(extract(ball, count).positions) == crossed


def test_empty_field_gives_no_faces() -> None:
    layers = [(np.eye(3), np.zeros(3)), (np.zeros((1, 3)), np.ones(1))]
    surface = extract(tiny.relu_network(layers), 32)
    assert surface.positions.shape == (0, 3)
    assert surface.faces.shape == (0, 3)


def test_steep_field_loses_nothing() -> None:
    slope = 3.0
    axes = np.vstack([np.eye(3), -np.eye(3)])
    steep = tiny.relu_network(
        [(axes, np.zeros(6)), (np.full((1, 6), slope), np.array([-0.7 * slope]))]
    )
    gentle = tiny.octahedron(0.7)
    assert len(extract(steep, 40).faces) == len(extract(gentle, 40).faces)


def dented(depth: float, width: float) -> Network:
    """An octahedron of size 0.5 and, round (0, 0, 0.85), a dent of the field below zero."""
    axes = np.vstack([np.eye(3), -np.eye(3)])
    first = np.vstack([axes, axes])
    bias = np.concatenate([np.zeros(6), -axes[:, 2] * 0.85])
    second = np.zeros((2, 12))
    second[0, :6], second[1, 6:] = 1 / np.sqrt(3), -1.0
    last = np.array([[1.0, -depth / width]])
    layers = [(first, bias), (second, np.array([0.0, width])), (last, [-0.5 / np.sqrt(3)])]
    return tiny.relu_network([(np.asarray(w), np.asarray(b)) for w, b in layers])


@pytest.mark.parametrize("resolution", [64, 128])
@pytest.mark.parametrize("depth", [0.5, 2.0])
def test_where_the_field_is_steeper_than_elsewhere_the_surface_is_closed_too(
    depth: float, resolution: int
) -> None:
    assert_closed(extract(dented(depth, width=0.2), resolution).faces)


def test_noise_is_told_from_surface() -> None:
    network = dented(depth=0.5, width=0.2)
    surface = extract(network, 64)
    assert components(surface)[0] == 2
    cleaned, report = without_noise(network, surface)
    assert (report.kept, report.dropped) == (1, 1)
    assert report.dropped_faces == len(surface.faces) - len(cleaned.faces) > 0
    assert_sound(cleaned.positions, cleaned.faces)
    assert np.abs(cleaned.positions).max() < 0.51
    kept, report = without_noise(network, surface, keep=True)
    assert (report.kept, report.dropped) == (2, 0)
    assert np.array_equal(kept.faces, surface.faces)


def test_nothing_is_real_outside_the_unit_ball() -> None:
    # Two octahedra with slopes of 1, one of them in a corner of the cube.
    axes = np.vstack([np.eye(3), -np.eye(3)])
    away = (np.abs(axes) * 0.9).sum(axis=1) * axes.sum(axis=1)
    first, bias = np.vstack([axes, axes]), np.concatenate([np.zeros(6), -away])
    second = np.zeros((2, 12))
    second[0, :6], second[1, 6:] = 1 / np.sqrt(3), 1 / np.sqrt(3)
    # min(a, b) = a - relu(a - b), both of them positive after a shift.
    third = np.array([[1.0, 0.0], [1.0, -1.0]])
    network = tiny.relu_network(
        [
            (first, bias),
            (second, np.zeros(2)),
            (third, np.zeros(2)),
            (np.array([[1.0, -1.0]]), np.array([-0.1])),
        ]
    )
    surface = extract(network, 64)
    assert components(surface)[0] == 2
    cleaned, report = without_noise(network, surface)
    assert (report.kept, report.dropped) == (1, 1)
    assert np.abs(cleaned.positions).max() < 0.2


def test_small_real_bodies_stay(ball: Network) -> None:
    tiny_ball = tiny.octahedron(0.05)
    surface = extract(tiny_ball, 64)
    unwanted, _ = spurious(tiny_ball, surface)
    assert not unwanted.any()


def beside(gap: float, slope: float) -> Network:
    """An octahedron with its tip at x = 0.5, and `gap` further on a speck of that slope."""
    axes, radius = np.vstack([np.eye(3), -np.eye(3)]), 0.014
    away = 0.5 + gap + radius
    second = np.zeros((2, 12))
    second[0, :6], second[1, 6:] = 1 / np.sqrt(3), slope / np.sqrt(3)
    body, speck = 0.5 / np.sqrt(3), slope * radius / np.sqrt(3)
    layers = [
        (np.vstack([axes, axes]), np.concatenate([np.zeros(6), -away * axes[:, 0]])),
        (second, np.zeros(2)),
        # min(a, b) = a - relu(a - b), where both are shifted to be positive.
        (np.array([[1.0, 0.0], [1.0, -1.0]]), np.array([0.0, speck - body])),
        (np.array([[1.0, -1.0]]), np.array([-body])),
    ]
    return tiny.relu_network(layers)


@pytest.mark.parametrize(
    ("gap", "slope", "cells", "dropped"),
    [
        (0.01, 0.3, 256, 0),
        (0.1, 0.3, 256, 1),
        (0.1, 0.9, 256, 0),
        (0.01, 0.3, 128, 1),
        (0.01, 0.3, 160, 0),
        (0.01, 0.9, 128, 0),
    ],
)
def test_flat_specks_are_noise_where_nothing_else_is_near_or_of_a_single_cell(
    gap: float, slope: float, cells: int, dropped: int
) -> None:
    network = beside(gap, slope)
    surface = extract(network, cells)
    assert components(surface)[0] == 2
    assert without_noise(network, surface)[1].dropped == dropped


def hollow(outer: float, inner: float) -> Network:
    """An octahedron with a hollow: the middle of its wall is the ridge of the field."""
    axes = np.vstack([np.eye(3), -np.eye(3)])
    middle, half = (outer + inner) / 2 / np.sqrt(3), (outer - inner) / 2 / np.sqrt(3)
    away = np.full((2, 6), 1 / np.sqrt(3)) * [[1.0], [-1.0]]
    layers = [(axes, np.zeros(6)), (away, [-middle, middle]), (np.ones((1, 2)), [-half])]
    return tiny.relu_network([(np.asarray(w), np.asarray(b)) for w, b in layers])


@pytest.mark.parametrize(("inner", "dropped"), [(0.06, 1), (0.5, 0)])
def test_small_hollows_are_dropped_and_rooms_stay(inner: float, dropped: int) -> None:
    network = hollow(0.8, inner)
    surface = extract(network, 96)
    assert components(surface)[0] == 2
    assert without_noise(network, surface)[1].dropped == dropped


def test_without_renumbers() -> None:
    positions = np.arange(18, dtype=np.float32).reshape(6, 3)
    surface = Surface(positions, np.array([[0, 1, 2], [3, 4, 5]], np.int32), 0.1)
    count, labels = components(surface)
    assert count == 2
    kept = without(surface, np.array([True, False]), labels)
    assert np.array_equal(kept.positions, positions[3:])
    assert np.array_equal(kept.faces, [[0, 1, 2]])
