"""The resolution and the number of faces that an asset gets when nobody asks for any."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nispcodec
from nispcodec.core.network import Network
from nispcodec.extract.config import ExtractConfig, ResolutionConfig, SimplifyConfig
from nispcodec.extract.isosurface import Surface, near_surface
from nispcodec.extract.meshing import default_resolution, negligible_error, textured_mesh
from nispcodec.extract.simplify import deviation
from nispcodec.extract.thin_walls import thin_share
from nispcodec.model import NispModel
from tests import tiny
from tests.extract.surfaces import areas, assert_closed
from tests.tiny import field_of, varied


def plate(thickness: float) -> Network:
    """max(|z| - thickness / 2, (|x| + |y|) / 2 - 0.2): a square plate, solid inside."""
    axes = np.vstack([np.eye(3), -np.eye(3)])
    ways = np.array([[0, 0, 1, 0, 0, 1], [0.5, 0.5, 0, 0.5, 0.5, 0]])
    bias = np.array([-thickness / 2, -0.2])
    # max(a, b) = b + relu(a - b), and b = relu(b) - relu(-b).
    second = np.vstack([ways[0] - ways[1], ways[1], -ways[1]])
    seconds = np.array([bias[0] - bias[1], bias[1], -bias[1]])
    last = np.array([[1.0, 1.0, -1.0]])
    return tiny.relu_network([(axes, np.zeros(6)), (second, seconds), (last, np.zeros(1))])


@pytest.mark.parametrize(("thickness", "least", "most"), [(0.003, 0.9, 1), (0.1, 0, 0.2)])
def test_thin_walls_are_told_though_no_grid_point_lies_inside(
    thickness: float, least: float, most: float
) -> None:
    network = plate(thickness)
    points, size = near_surface(network, ResolutionConfig.least)
    assert least <= thin_share(network, points, size, 0.01) <= most


def test_islands_in_a_membrane_go_with_it() -> None:
    # Chart 1, an opening, where x > 0, but for the tip, which the network gives to chart 0.
    rows = np.array([[-1.0, 0, 0], [1.0, 0, 0], [1.0, 0, 0]]), np.array([0, 0, -0.792])
    last = np.array([[1.0, 0, 1000], [0, 1, 0]]), np.zeros(2)
    chart, table = tiny.relu_network([rows, last]), field_of(tiny.document()).charts
    opened = replace(table, has_uv=np.array([True, False]), openings=True)
    model = NispModel(varied(tiny.document(), chart=chart))
    whole, half = (
        NispModel(varied(model.document, charts=charts)).to_mesh() for charts in (table, opened)
    )
    right = [model.document.frame.to_normalized(mesh.positions)[:, 0] for mesh in (whole, half)]
    assert right[0].max() > 0.79
    assert right[1].max() < 0.02
    total, left = (areas(each.positions, each.faces).sum() for each in (whole, half))
    assert 0.45 < left / total < 0.55


def test_by_default_there_are_as_few_faces_as_the_files_own_error_lets() -> None:
    document, sdf = tiny.document(tiny.sphere()), tiny.sphere()
    config = ExtractConfig(ResolutionConfig(least=96, most=96))
    fine, rough = (
        textured_mesh(replace(document, info={"distance_error": error}), config=config)[0]
        for error in (4.5e-4, 5.5e-4)
    )
    every = NispModel(document).to_mesh(96)
    assert len(rough.faces) < len(fine.faces) < 0.5 * len(every.faces)
    assert_closed(rough.faces)
    positions = document.frame.to_normalized(rough.positions).astype(np.float32)
    surface = Surface(positions, rough.faces, 0.1)
    assert deviation(sdf, surface) <= 1.05 * negligible_error({"distance_error": 5.5e-4})


def test_by_default_there_is_a_bound_that_seams_keep_too() -> None:
    document = tiny.document(tiny.sphere(), tiny.octants())
    exact = replace(document, info={"distance_error": 1e-9})
    limits = ResolutionConfig(least=64, most=64)
    config = ExtractConfig(limits, simplify=SimplifyConfig(most=1500, finest=1e-9))
    mesh, _ = textured_mesh(exact, config=config)
    assert 1000 < len(mesh.faces) <= 1500
    assert mesh.warnings == ()
    # Who asks for a grid gets all of it.
    assert len(textured_mesh(exact, 64, config=config)[0].faces) > 5 * 1500


@pytest.mark.parametrize("faces", [1000, 300])
def test_seams_are_among_the_faces_asked_for(faces: int) -> None:
    document = tiny.document(tiny.sphere(), tiny.octants())
    mesh = NispModel(document).to_mesh(48, faces=faces)
    assert 0.7 * faces < len(mesh.faces) <= faces
    assert mesh.warnings == ()


def test_so_few_that_seams_take_all_are_had_or_said_not_to_be() -> None:
    document = tiny.document(tiny.sphere(), tiny.octants())
    mesh = NispModel(document).to_mesh(48, faces=100)
    # The seams of eight charts leave any number of them: with other threads, another one.
    assert 8 < len(mesh.faces) < 250
    assert bool(mesh.warnings) == (len(mesh.faces) > 100)


@pytest.mark.parametrize("told", [0, -1.0, float("nan"), "small", True, None])
def test_errors_that_make_no_sense_are_not_believed(told: Any) -> None:
    usual = SimplifyConfig.usual
    assert negligible_error({} if told is None else {"distance_error": told}) == usual


def test_errors_are_believed_within_limits() -> None:
    assert negligible_error({"distance_error": 1e-9}) == SimplifyConfig.finest
    assert negligible_error({"distance_error": 5}) == SimplifyConfig.coarsest
    assert negligible_error({"distance_error": float("inf")}) == SimplifyConfig.coarsest
    assert negligible_error({"distance_error": 4e-4}) == pytest.approx(1.4e-4)


def test_default_resolution_follows_the_walls() -> None:
    assert default_resolution(plate(0.003), 0.0) == ResolutionConfig.most
    assert default_resolution(tiny.octahedron(), 0.0) == ResolutionConfig.least


@pytest.mark.parametrize(
    ("half_thickness", "expected"), [(0.05, ResolutionConfig.least), (0.004, 510), (1e-4, 2048)]
)
def test_sheets_get_a_cell_for_half_their_thickness(half_thickness: float, expected: int) -> None:
    document = tiny.varied(tiny.document(tiny.octahedron()), half_thickness=half_thickness)
    assert default_resolution(field_of(document).sdf, field_of(document).half_thickness) == expected


def test_no_surface_at_all_has_a_default_too() -> None:
    assert default_resolution(tiny.octahedron(-1), 0.0) == ResolutionConfig.least


def test_a_simplifier_that_is_stuck_is_not_asked_again(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []

    def stuck(_: Network, surface: Surface, faces: int, config: SimplifyConfig) -> Surface:
        asked.append(faces)
        return surface

    monkeypatch.setattr("nispcodec.extract.meshing.simplified", stuck)
    mesh = NispModel(tiny.document()).to_mesh(24, faces=100)
    assert asked == [100]
    (warning,) = mesh.warnings
    assert warning.startswith(f"expected at most 100 faces, found {len(mesh.faces):,}: ")


def test_as_many_faces_as_asked_for_are_no_warning() -> None:
    assert NispModel(tiny.document()).to_mesh(24, faces=300).warnings == ()


@pytest.mark.parametrize("stem", ["uv-nan", "uv-infinite"])
def test_uvs_that_are_not_finite_become_0(stem: str) -> None:
    folder = Path(__file__).parents[1] / "conformance"
    mesh = nispcodec.load(folder / f"{stem}.nisp").to_mesh(32)
    assert len(mesh.faces) > 0
    assert not mesh.uvs.any()
