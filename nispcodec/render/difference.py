"""Where two pictures differ, how much, and what to look at more closely."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.core.arrays import Float32Array
from nispcodec.render.camera import Camera
from nispcodec.render.fragments import Scene

# A difference of this, of a channel's whole range, is black.
SCALE = 0.25
ZOOM = 6.0
# Differences are judged over windows of this share of the picture, so that outlines weigh little.
WINDOW = 0.04


def difference(first: Float32Array, second: Float32Array) -> Float32Array:
    """(h, w) float32: the largest difference over the channels of two pictures (h, w, 3)."""
    largest: Float32Array = np.abs(first - second).max(axis=2)
    return largest


def heat(values: Float32Array) -> Float32Array:
    """Values (...) as colors (..., 3) float32: white at 0, yellow, red, black from SCALE on."""
    share = values[..., None] / SCALE
    colors: Float32Array = 1 - np.clip(3 * share - np.array([2, 1, 0]), 0, 1)
    return colors.astype(np.float32)


def close_ups(
    scene: Scene, views: list[Camera], differences: list[Float32Array], count: int
) -> list[Camera]:
    """`count` cameras close to where differences are largest, each well away from the others.

    `differences` are those (size, size) of the pictures from each of the `views`. The scene tells
    how far away the surface is.
    """
    from scipy.ndimage import uniform_filter

    smooth = [uniform_filter(each, max(3, round(WINDOW * len(each)))) for each in differences]
    cameras: list[Camera] = []
    for _ in range(count):
        worst = max(range(len(views)), key=lambda i: float(smooth[i].max()))
        cameras.append(_on(scene, views[worst], smooth[worst]))
        for view, each in zip(views, smooth, strict=True):
            _pass_over(each, view, cameras[-1].target)
    return cameras


def _pass_over(smooth: Float32Array, view: Camera, target: tuple[float, float, float]) -> None:
    """Forget what a close-up of the target shows, and as much around it, whatever the view."""
    middle = view.places(np.array([target]))[0, ::-1]
    low, high = (np.clip((middle + side / ZOOM) * len(smooth), 0, None) for side in (-1, 1))
    smooth[int(low[0]) : int(high[0]), int(low[1]) : int(high[1])] = 0


def _on(scene: Scene, view: Camera, smooth: Float32Array) -> Camera:
    """The camera turned to the brightest place, nearer by ZOOM."""
    row, column = np.unravel_index(int(smooth.argmax()), smooth.shape)
    place = (np.array([each + 0.5]) / len(smooth) for each in (column, row))
    direction = view.directions(*place)
    found = scene.cast(view.eye[None].astype(np.float32), direction, 0).fragments.distances
    # Beside the surface: what is in the plane of the middle.
    middle = float(np.linalg.norm(view.eye)) / float(-direction[0] @ view.axes[2])
    target = view.eye + (float(found[0]) if len(found) else middle) * direction[0]
    return replace(view, target=tuple(target.tolist()), zoom=ZOOM)
