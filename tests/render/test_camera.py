from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.errors import QueryError
from nispcodec.render.camera import NAMED, Camera, turntable, view

MIDDLE = np.array([0.5])


@pytest.mark.parametrize("name", NAMED)
def test_axes_are_a_right_handed_frame_that_looks_at_the_middle(name: str) -> None:
    camera = view(name)
    np.testing.assert_allclose(camera.axes @ camera.axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(camera.axes) == pytest.approx(1)
    np.testing.assert_allclose(camera.directions(MIDDLE, MIDDLE)[0], -camera.axes[2], atol=1e-6)


def test_named_views_stand_where_their_names_say() -> None:
    expected = {"front": (0, 0, 1), "right": (1, 0, 0), "back": (0, 0, -1), "top": (0, 1, 0)}
    for name, side in expected.items():
        np.testing.assert_allclose(view(name).axes[2], side, atol=1e-12)


def test_pictures_are_not_mirrored() -> None:
    left = Camera(0, 0).directions(np.array([0.0]), MIDDLE)[0]
    top = Camera(0, 0).directions(MIDDLE, np.array([0.0]))[0]
    assert left[0] < 0 < top[1]


def test_azimuth_and_elevation() -> None:
    camera = view("90,30", fov=50)
    assert (camera.azimuth, camera.elevation, camera.fov) == (90, 30, 50)
    assert camera.eye[1] == pytest.approx(np.linalg.norm(camera.eye) / 2)


@pytest.mark.parametrize("text", ["frnt", "1,2,3", "1,91", "nan,0", "", "a,b"])
def test_unknown_views_are_refused(text: str) -> None:
    with pytest.raises(QueryError, match="view: expected front"):
        view(text)


@pytest.mark.parametrize("fov", [5, 32, 100])
def test_every_view_sees_the_whole_unit_ball(fov: float) -> None:
    for camera in turntable(5, fov=fov):
        distance = float(np.linalg.norm(camera.eye))
        assert np.degrees(np.arcsin(1 / distance)) <= camera.fov / 2


def test_zoom_narrows_the_picture() -> None:
    near, far = Camera(zoom=4), Camera()
    assert near.half_width == pytest.approx(far.half_width / 4)
    np.testing.assert_array_equal(near.eye, far.eye)


def test_places_are_where_directions_go() -> None:
    camera = Camera(50, -20, target=(0.1, 0.2, 0.0), zoom=3)
    x, y = np.array([0.2, 0.9]), np.array([0.4, 0.1])
    points = camera.eye + 2.5 * camera.directions(x, y)
    np.testing.assert_allclose(camera.places(points), np.column_stack([x, y]), atol=1e-5)
