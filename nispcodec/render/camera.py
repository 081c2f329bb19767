"""Pinhole cameras around the unit ball of the normalized frame, and the views that have names."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from nispcodec.core.arrays import Float32Array, Float64Array, FloatArray
from nispcodec.core.errors import QueryError

NAMED = {
    "front": (0.0, 0.0),
    "right": (90.0, 0.0),
    "back": (180.0, 0.0),
    "left": (270.0, 0.0),
    "top": (0.0, 90.0),
    "bottom": (0.0, -90.0),
}
# The unit ball fills the picture but for this share.
ROOM = 1.02


@dataclass(frozen=True)
class Camera:
    """A pinhole camera that looks at `target` from where the unit ball just fits in; y is up.

    azimuth    degrees around y: 0 from +z (the front of a glTF asset), 90 from +x
    elevation  degrees above the horizon, -90 to 90
    fov        angle in degrees that the picture spans, 1 to 120
    target     the point in the middle of the picture, normalized frame
    zoom       how many times larger than life: narrows the angle, the camera stays where it is
    """

    azimuth: float = 30.0
    elevation: float = 20.0
    fov: float = 32.0
    target: tuple[float, float, float] = (0.0, 0.0, 0.0)
    zoom: float = 1.0

    @cached_property
    def axes(self) -> Float64Array:
        """(3, 3): right, up and backward unit vectors as rows."""
        a, e = np.radians(self.azimuth), np.radians(self.elevation)
        backward = (np.sin(a) * np.cos(e), np.sin(e), np.cos(a) * np.cos(e))
        right = (np.cos(a), 0.0, -np.sin(a))
        return np.stack([right, np.cross(backward, right), backward])

    @property
    def eye(self) -> Float64Array:
        """(3,): where the camera stands, normalized frame."""
        distance = ROOM / np.sin(np.radians(self.fov) / 2)
        return np.asarray(self.target) + distance * self.axes[2]

    @property
    def half_width(self) -> float:
        """Half the picture's width at distance 1."""
        return float(np.tan(np.radians(self.fov) / 2)) / self.zoom

    def directions(self, x: FloatArray, y: FloatArray) -> Float32Array:
        """Unit directions (n, 3) float32 from the eye through points x (n,), y (n,) of the picture.

        (0, 0) is its top left corner, (1, 1) its bottom right.
        """
        across, down = (2 * x - 1) * self.half_width, (2 * y - 1) * self.half_width
        rays = np.column_stack([across, -down, -np.ones(len(x))]) @ self.axes
        return (rays / np.linalg.norm(rays, axis=1, keepdims=True)).astype(np.float32)

    def places(self, points: FloatArray) -> Float64Array:
        """Places (n, 2) in the picture, see `directions`, of points (n, 3) in front of the eye."""
        right, up, backward = self.axes @ (points - self.eye).T
        return 0.5 + 0.5 * np.column_stack([right, -up]) / (-backward * self.half_width)[:, None]


def view(text: str, fov: float = 32.0) -> Camera:
    """The camera of "front", "back", "left", "right", "top", "bottom" or "azimuth,elevation".

    All angles are in degrees. Raises QueryError for another text.
    """
    if text in NAMED:
        return Camera(*NAMED[text], fov)
    try:
        azimuth, elevation = map(float, text.split(","))
    except ValueError:
        azimuth = elevation = float("nan")
    if not (abs(azimuth) <= 3600 and abs(elevation) <= 90):
        known = ", ".join(NAMED)
        raise QueryError(f"view: expected {known} or azimuth,elevation in degrees, found {text!r}")
    return Camera(azimuth, elevation, fov)


def turntable(
    count: int, elevation: float = 20.0, fov: float = 32.0, start: float = 30.0
) -> list[Camera]:
    """`count` cameras evenly around the y axis, the first at azimuth `start`; angles in degrees."""
    return [Camera(start + 360.0 * i / count, elevation, fov) for i in range(count)]
