"""Signed distances on a regular grid, for programs that take a field as samples."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from nispcodec.core.arrays import Float32Array, Float64Array
from nispcodec.core.progress import Listener, silent

BLOCK = 1 << 18
"""Points that are asked at a time: this bounds memory."""


@dataclass(frozen=True)
class SdfGrid:
    """A box of sample points with equal spacing along x, y and z, world frame.

    origin    (3,) where sample [0, 0, 0] is
    spacing   from a sample to the next along each axis
    shape     samples along x, y and z
    distance  points (n, 3) float64 -> signed distances (n,) float32; asked anew whenever values are
    warnings  what was left out of the surface, one sentence each
    """

    origin: tuple[float, float, float]
    spacing: float
    shape: tuple[int, int, int]
    distance: Callable[[Float64Array], Float32Array]
    warnings: tuple[str, ...] = ()

    def values(self) -> Float32Array:
        """(nx, ny, nz) float32: signed distances, negative inside, in world units."""
        return np.concatenate(list(self.slabs()))

    def slabs(self) -> Iterator[Float32Array]:
        """The values in parts (k, ny, nz), one after another along x."""
        rows, columns = self.shape[1:]
        thick = max(1, BLOCK // (rows * columns))
        for start in range(0, self.shape[0], thick):
            steps = np.indices((min(thick, self.shape[0] - start), rows, columns))
            steps[0] += start
            points = np.asarray(self.origin) + self.spacing * steps.reshape(3, -1).T
            yield self.distance(points).reshape(-1, rows, columns)

    def save(self, path: str | Path, progress: Listener = silent) -> None:
        """Write an `.npz`, a slab at a time, whole or not at all.

        It holds `sdf` (nx, ny, nz) float32, `origin` (3,) and `spacing` float64, and the texts
        `units` and `sign`, which say what those are. Raises NispError when it cannot be written.
        """
        from nispcodec.io.write.npz import write_grid

        write_grid(self, Path(path), progress)
