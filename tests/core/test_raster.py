from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from nispcodec.core import raster
from nispcodec.core.arrays import BoolArray, Float64Array

HEIGHT, WIDTH = 5, 8
# No center of a texel lies on a line between such corners, but for lines along the axes.
COORDINATES = st.integers(0, 97).map(lambda each: each / 97)
FACES = hnp.arrays(
    np.float64, st.tuples(st.integers(0, 5), st.just(3), st.just(2)), elements=COORDINATES
)
SQUARE = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]], float)


def centers(rows: Any, columns: Any) -> Float64Array:
    """UVs (n, 2) of the centers of texels."""
    return np.column_stack([(columns + 0.5) / WIDTH, 1 - (rows + 0.5) / HEIGHT])


def inside(face: Float64Array, at: Float64Array) -> BoolArray:
    """Which of (n, 2) points are on one side of all three edges, with some slack."""
    edges = np.roll(face, -1, axis=0) - face
    away = at[:, None] - face
    crosses = edges[:, 0] * away[..., 1] - edges[:, 1] * away[..., 0]
    area = edges[0, 0] * -edges[2, 1] + edges[0, 1] * edges[2, 0]
    if area == 0:
        return np.zeros(len(at), np.bool_)
    return np.asarray((crosses * np.sign(area) >= -1e-12).all(axis=1))


@given(FACES)
@settings(max_examples=60)
def test_a_texel_belongs_to_the_last_face_that_holds_its_center(faces: Float64Array) -> None:
    found = raster.texels(faces, HEIGHT, WIDTH)
    owners = np.full((HEIGHT, WIDTH), -1)
    rows, columns = (each.ravel() for each in np.indices((HEIGHT, WIDTH)))
    for number, face in enumerate(faces):
        owners.ravel()[inside(face, centers(rows, columns))] = number
    drawn = np.full((HEIGHT, WIDTH), -1)
    drawn[found.rows, found.columns] = found.faces
    np.testing.assert_array_equal(drawn, owners)
    np.testing.assert_array_equal(raster.coverage(faces, HEIGHT, WIDTH), owners >= 0)


@given(FACES)
@settings(max_examples=60)
def test_weights_lead_to_the_center(faces: Float64Array) -> None:
    found = raster.texels(faces, HEIGHT, WIDTH)
    assert found.weights.shape == (len(found.rows), 3)
    assert (found.weights >= -1e-9).all()
    np.testing.assert_allclose(found.weights.sum(axis=1), 1)
    uvs = np.einsum("nc,ncd->nd", found.weights, faces[found.faces])
    np.testing.assert_allclose(uvs, centers(found.rows, found.columns), atol=1e-9)


@pytest.mark.parametrize(("height", "width"), [(1, 1), (7, 3), (16, 16)])
def test_an_atlas_without_gaps_leaves_no_texel_out(height: int, width: int) -> None:
    found = raster.texels(SQUARE, height, width)
    assert list(zip(found.rows.tolist(), found.columns.tolist(), strict=True)) == list(
        np.ndindex(height, width)
    )


def test_the_first_row_is_on_top() -> None:
    found = raster.texels(SQUARE / 2, 4, 4)
    assert set(found.rows.tolist()) == {2, 3}
    assert set(found.columns.tolist()) == {0, 1}


def test_parts_in_which_it_is_done_change_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    faces = np.random.default_rng(0).random((40, 3, 2))
    whole = raster.texels(faces, 32, 32)
    monkeypatch.setattr(raster, "CANDIDATES", 100)
    parts = raster.texels(faces, 32, 32)
    for name in ("rows", "columns", "faces", "weights"):
        np.testing.assert_array_equal(getattr(whole, name), getattr(parts, name))


@given(hnp.arrays(np.bool_, (4, 6)), st.integers(0, 9))
@settings(max_examples=40)
def test_padding_takes_the_nearest_color_and_keeps_what_is_covered(
    covered: BoolArray, seed: int
) -> None:
    image = np.random.default_rng(seed).integers(0, 256, (4, 6, 3)).astype(np.uint8)
    found = raster.padded(image, covered)
    if not covered.any():
        assert found is image
        return
    used = np.argwhere(covered)
    for place in np.ndindex(4, 6):
        far = ((used - place) ** 2).sum(axis=1)
        colors = [image[tuple(each)].tolist() for each in used[far == far.min()]]
        assert found[place].tolist() in colors
