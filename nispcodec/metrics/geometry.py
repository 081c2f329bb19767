"""How far two surfaces lie apart, from points of each matched with their closest on the other."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array
from nispcodec.metrics.psnr import psnr
from nispcodec.metrics.surface import Surface, SurfacePoints


@dataclass(frozen=True)
class Matches:
    """Pairs of points: each on the original with its counterpart on the decoded surface."""

    original: SurfacePoints
    decoded: SurfacePoints

    def __add__(self, other: Matches) -> Matches:
        return Matches(self.original + other.original, self.decoded + other.decoded)

    def __getitem__(self, chosen: BoolArray) -> Matches:
        return Matches(self.original[chosen], self.decoded[chosen])

    @property
    def distances(self) -> Float64Array:
        """(n,): how far the points of each pair lie apart."""
        distances: Float64Array = np.linalg.norm(self.offsets, axis=1)
        return distances

    @property
    def offsets(self) -> Float64Array:
        """(n, 3): from the original's point to the decoded one."""
        return self.decoded.positions - self.original.positions


def distance_summary(distances: Float64Array) -> dict[str, float]:
    """Mean, 99th percentile and maximum of (n,) distances."""
    return {
        "mean": float(distances.mean()),
        "p99": float(np.percentile(distances, 99)),
        "max": float(distances.max()),
    }


def d1_psnr(directions: Iterable[Matches], peak: float) -> float:
    """Point-to-point PSNR (D1) of MPEG PCC (Tian et al. 2017), dB, of the worse direction.

    The counterpart of a point is the closest point of the whole other surface, so there is no
    floor from the sampling density; `peak` is the bounding box's diagonal, normalized frame.
    """
    return min(psnr(float((each.offsets**2).sum(axis=1).mean()), peak) for each in directions)


def d2_psnr(original: Surface, directions: Iterable[Matches], peak: float) -> float:
    """Point-to-plane PSNR (D2) of MPEG PCC (Tian et al. 2017), dB, of the worse direction.

    Offsets are taken along the original's face normals; `peak` as in `d1_psnr`.
    """
    return min(psnr(float((_along(original, each) ** 2).mean()), peak) for each in directions)


def normal_consistency(original: Surface, decoded: Surface, matches: Matches) -> float:
    """Mean |cosine| between the face normals of each pair; 1 is best."""
    first = original.normals[matches.original.faces]
    second = decoded.normals[matches.decoded.faces]
    return float(np.abs((first * second).sum(axis=1)).mean())


def _along(original: Surface, matches: Matches) -> Float64Array:
    normals = original.normals[matches.original.faces]
    along: Float64Array = (matches.offsets * normals).sum(axis=1)
    return along
