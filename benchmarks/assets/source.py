"""An asset that is coded and measured: its file, its mesh, and the reference to compare with."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from nispcodec.core.arrays import BoolArray
from nispcodec.core.asset import TexturedMesh
from nispcodec.io.load import load_mesh
from nispcodec.metrics.compare import Reference
from nispcodec.metrics.sides import sides_of
from nispcodec.metrics.surface import SurfacePoints

SEED = 0
SAMPLES = 100_000
ROUGH = 2000

# Where on a face one looks to tell whether it is hidden, if none of the reference's points says so.
PLACES = np.array([[1, 1, 1], [8, 1, 1], [1, 8, 1], [1, 1, 8]])


@dataclass(frozen=True)
class Source:
    """One asset on disk; what is computed from it is kept."""

    path: Path

    @property
    def name(self) -> str:
        """The file's name without suffix."""
        return self.path.stem

    @cached_property
    def mesh(self) -> TexturedMesh:
        """The mesh as our reader gives it."""
        return load_mesh(self.path)

    @cached_property
    def reference(self) -> Reference:
        """SAMPLES points with SEED."""
        return Reference.of(self.mesh, samples=SAMPLES, seed=SEED)

    @cached_property
    def hidden_share(self) -> float:
        """About how much of the surface lies inside other bodies: enough to plan with."""
        return float(Reference.of(self.mesh, samples=ROUGH, seed=SEED).sides.hidden.mean())

    @cached_property
    def outer_faces(self) -> BoolArray:
        """(m,): which faces can be seen from outside, wholly or in part."""
        surface = self.reference.surface
        outer = np.zeros(len(self.mesh.faces), dtype=np.bool_)
        outer[self.reference.seen.faces] = True
        unknown = np.flatnonzero(~outer)
        faces = np.repeat(unknown, len(PLACES))
        weights = np.tile(PLACES / PLACES.sum(axis=1, keepdims=True), (len(unknown), 1))
        points = SurfacePoints(faces, weights, surface.interpolate(faces, weights))
        outer[faces[sides_of(surface, points).outer]] = True
        return outer


def sources(folder: Path) -> list[Source]:
    """NAME/NAME.obj or NAME.obj below a folder, by name."""
    found = sorted([*folder.glob("*.obj"), *folder.glob("*/*.obj")], key=lambda path: path.stem)
    return [Source(path) for path in found]
