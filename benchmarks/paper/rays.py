"""Rays of cameras through pixels, cut to the box around an asset, as tensors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor

from nispcodec.core.arrays import FloatArray
from nispcodec.render.camera import Camera

# What stands on the box's faces is inside of it (normalized frame).
MARGIN = 0.01


@dataclass(frozen=True)
class Rays:
    """n rays, normalized frame, float32 on one device.

    origins     (n, 3)
    directions  (n, 3), unit
    near, far   (n, 1): the distances at which the ray enters and leaves the box
    """

    origins: Tensor
    directions: Tensor
    near: Tensor
    far: Tensor

    def __len__(self) -> int:
        return len(self.origins)

    def __getitem__(self, chosen: Tensor | slice) -> Rays:
        parts = (self.origins, self.directions, self.near, self.far)
        return Rays(*(part[chosen] for part in parts))

    def at(self, distances: Tensor) -> Tensor:
        """(n, k, 3): the points at distances (n, k)."""
        return self.origins[:, None] + distances[..., None] * self.directions[:, None]


def box_of(points: FloatArray) -> FloatArray:
    """(2, 3): the least and the largest coordinates of points (n, 3), and a margin."""
    return np.stack([points.min(axis=0) - MARGIN, points.max(axis=0) + MARGIN])


def rays_of(
    cameras: Sequence[Camera], size: int, box: FloatArray, device: str
) -> tuple[Rays, Tensor]:
    """Rays through the middles of all pixels of all cameras that hit the box; which do.

    The latter is (cameras * size * size,) bool: camera by camera, row by row from the top.
    """
    middle = (np.arange(size) + 0.5) / size
    x, y = (each.ravel() for each in np.meshgrid(middle, middle))
    directions = np.concatenate([camera.directions(x, y) for camera in cameras])
    origins = np.repeat([camera.eye for camera in cameras], size * size, axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        walls = (box[:, None] - origins) / directions
    near, far = walls.min(axis=0).max(axis=1), walls.max(axis=0).min(axis=1)
    hit = far > near
    parts = (origins, directions, near[:, None], far[:, None])
    return Rays(*(tensor(part[hit], device) for part in parts)), torch.from_numpy(hit)


def tensor(values: FloatArray, device: str) -> Tensor:
    """Values as float32 on a device."""
    return torch.from_numpy(np.ascontiguousarray(values, np.float32)).to(device)
