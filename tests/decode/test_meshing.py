"""The resolution that an asset gets when nobody asks for one."""

from __future__ import annotations

from dataclasses import replace

import pytest

from nispcodec.decode.meshing import LEAST, MOST, default_resolution
from nispcodec.network import Network
from tests import tiny


def test_default_resolution_follows_the_asset() -> None:
    wanted = [default_resolution(tiny.document(tiny.octahedron(size))) for size in (1, 0.7, 0.1)]
    assert wanted[0] == LEAST < wanted[1] < wanted[2] == MOST


@pytest.mark.parametrize(("shell", "expected"), [(0.05, LEAST), (0.004, 510), (1e-4, 2048)])
def test_sheets_get_a_cell_for_half_their_thickness(shell: float, expected: int) -> None:
    document = replace(tiny.document(tiny.octahedron(1)), shell=shell)
    assert default_resolution(document) == expected


def test_no_surface_at_all_has_a_default_too(nothing: Network) -> None:
    assert default_resolution(tiny.document(nothing)) == MOST


@pytest.fixture
def nothing() -> Network:
    return tiny.octahedron(-1)
