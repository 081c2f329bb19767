"""Surfaces grow back as they were, from few bits where they are regular."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from nispcodec.core.errors import FormatError
from nispcodec.core.mesh_part import MeshPart
from nispcodec.format.mesh import manifold
from nispcodec.format.mesh.binary_coder import Decoder, Encoder
from nispcodec.format.mesh.connectivity import Growth, Known, Surface
from tests.format.mesh.parts import box, grid, parts


def grown(made: MeshPart) -> tuple[bytes, Surface, Known]:
    twin = manifold.twins(made.faces, made.sheet, lambda one, other: 0)
    known = Known(twin.tolist(), manifold.fans(twin).tolist(), [-1] * len(made.faces))
    encoder = Encoder()
    surface = Growth(encoder, known).grow(len(made.faces))
    return encoder.finish(), surface, known


@given(parts())
def test_decoded_is_what_the_encoder_saw(made: MeshPart) -> None:
    data, surface, known = grown(made)
    found = Growth(Decoder(data), None).grow(len(made.faces))
    assert found == surface
    points = np.array(known.fans)[known.sides]
    assert len(set(zip(points.tolist(), surface.corners, strict=True))) == surface.points
    theirs = np.array(known.twin)[known.sides]
    ours = [known.sides[other] if other >= 0 else -1 for other in surface.twin]
    assert ours == theirs.tolist()


def test_regular_surfaces_take_next_to_nothing() -> None:
    assert len(grown(grid(16))[0]) < 48
    assert len(grown(box())[0]) < 10


def test_no_face_has_a_point_twice() -> None:
    refused = 0
    for seed in range(300):
        data = np.random.default_rng(seed).bytes(60)
        try:
            corners = Growth(Decoder(data), None).grow(40).corners
        except FormatError:
            refused += 1
            continue
        assert all(len(set(corners[at : at + 3])) == 3 for at in range(0, 120, 3))
    assert 0 < refused < 300


def test_bytes_that_end_early() -> None:
    data = grown(grid(30))[0]
    with pytest.raises(FormatError):
        Growth(Decoder(data[:4]), None).grow(1800)
