"""Which pieces of an extracted surface are real, and which are noise of the fitted field.

A fitted SDF may cross zero where there is no surface, far from its training samples. Such a
crossing gives itself away: it lies outside the normalized frame's unit ball, or the field around it
is no distance field and it is steep, or tiny and far from everything else. Tiny pieces beside
others are what is left of straps and wires, but for those of a single cell. A small hollow that
nothing leads into is dropped as well: nobody can see into it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import BoolArray, Float32Array, Float64Array, Int32Array, Int64Array
from nispcodec.core.connectivity import connected_components
from nispcodec.core.counted import counted
from nispcodec.core.network import Network
from nispcodec.extract.config import ComponentConfig
from nispcodec.extract.grid import CUBE
from nispcodec.extract.isosurface import BALL, Surface
from nispcodec.extract.neighbors import GroupedPoints, groups_with_neighbors
from nispcodec.infer.evaluate import gradient


@dataclass(frozen=True)
class ExtractionReport:
    """Counts of an extraction: cells along the cube's edge, connected components, dropped noise."""

    resolution: int
    kept: int
    dropped: int
    dropped_faces: int

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warnings for the user of the mesh: a sentence when something was dropped."""
        if not self.dropped:
            return ()
        what = counted(self.dropped, "spurious component")
        return (f"{what}, {counted(self.dropped_faces, 'face')}, dropped",)


def without_noise(
    network: Network,
    surface: Surface,
    keep: bool = False,
    config: ComponentConfig = ComponentConfig(),
) -> tuple[Surface, ExtractionReport]:
    """The surface without spurious components, unless they are to be kept, and the counts."""
    unwanted, labels = spurious(network, surface, config)
    unwanted |= _single_cells(network, surface, labels, len(unwanted), config)
    if keep:
        unwanted[:] = False
    cleaned = without(surface, unwanted, labels)
    report = ExtractionReport(
        resolution=round(2 * CUBE / surface.cell),
        kept=int((~unwanted).sum()),
        dropped=int(unwanted.sum()),
        dropped_faces=len(surface.faces) - len(cleaned.faces),
    )
    return cleaned, report


def components(surface: Surface) -> tuple[int, Int32Array]:
    """How many connected components, and the component of each vertex (n,)."""
    return connected_components(surface.faces[:, :2], surface.faces[:, 1:], len(surface.positions))


def spurious(
    network: Network, surface: Surface, config: ComponentConfig = ComponentConfig()
) -> tuple[BoolArray, Int32Array]:
    """Which components are noise (c,) bool, and the component of each vertex (n,).

    A component is noise when all of it lies outside the unit ball, when it is small and the field
    is steep on it, when it is small and isolated and the field is flat, or when it is a small
    hollow.
    """
    count, labels = components(surface)
    if count < 2:
        return np.zeros(count, np.bool_), labels
    nearest = np.full(count, np.inf)
    np.minimum.at(nearest, labels, np.linalg.norm(surface.positions, axis=1))
    vertices = np.bincount(labels, minlength=count)
    slope = _mean_slopes(network, surface, labels, vertices, config)
    small = vertices * surface.cell**2 < config.small_area
    flat = _isolated(surface, labels, (slope < config.flat) & small, config)
    hollow = _volumes(surface, labels, vertices < config.hollow_share * len(labels)) < 0
    return (nearest > BALL) | (slope > config.steep) | flat | hollow, labels


def _single_cells(
    network: Network, surface: Surface, labels: Int32Array, count: int, config: ComponentConfig
) -> BoolArray:
    """Which of several components (c,) bool are flat and of a single cell."""
    vertices = np.bincount(labels, minlength=count)
    single: BoolArray = (vertices <= config.single_cell) & (count > 1)
    if single.any():
        single &= _mean_slopes(network, surface, labels, vertices, config) < config.flat
    return single


def _isolated(
    surface: Surface, labels: Int32Array, small: BoolArray, config: ComponentConfig
) -> BoolArray:
    """Of some components (c,) bool those with no other component near."""
    if not small.any():
        return small
    apart, count = small[labels], len(small)
    members, points = labels[apart], surface.positions[apart]
    others = surface.positions[~apart]
    others = others[:: 1 + len(others) // config.neighbor_vertices]
    rest = GroupedPoints(others, np.full(len(others), count))
    beside = groups_with_neighbors(GroupedPoints(points, members), rest, config.isolated, count)
    sizes = np.maximum(np.bincount(members, minlength=count), 1)
    sums = np.stack([np.bincount(members, axis, count) for axis in points.T], axis=1)
    numbers = np.flatnonzero(small)
    centers = GroupedPoints(sums[numbers] / sizes[numbers, None], numbers)
    return small & ~beside & ~groups_with_neighbors(centers, centers, config.isolated, count)


def _volumes(surface: Surface, labels: Int32Array, small: BoolArray) -> Float64Array:
    """What each small closed component encloses; below 0 when its outside is within (Gauss)."""
    faces = surface.faces[small[labels[surface.faces[:, 0]]]]
    a, b, c = np.moveaxis(surface.positions[faces].astype(np.float64), 1, 0)
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6
    return np.bincount(labels[faces[:, 0]], volume, len(small)).astype(np.float64)


def _mean_slopes(
    network: Network,
    surface: Surface,
    labels: Int32Array,
    vertices: Int64Array,
    config: ComponentConfig,
) -> Float64Array:
    """Mean slope of the field on each small component, relative to the whole; 1 on large ones."""
    small = vertices < config.small_share * len(labels)
    chosen = np.flatnonzero(small[labels])
    totals = np.bincount(labels[chosen], _slopes(network, surface, chosen), minlength=len(small))
    some = np.arange(0, len(labels), 1 + len(labels) // config.slope_samples)
    whole = np.median(_slopes(network, surface, some))
    return np.where(small, totals / vertices / whole, 1.0)


def _slopes(network: Network, surface: Surface, chosen: Int64Array) -> Float32Array:
    slopes: Float32Array = np.linalg.norm(gradient(network, surface.positions[chosen])[1], axis=1)
    return slopes


def without(surface: Surface, unwanted: BoolArray, labels: Int32Array) -> Surface:
    """The surface without the components marked in `unwanted` (c,) bool."""
    if not unwanted.any():
        return surface
    keep = ~unwanted[labels]
    renumbered = (np.cumsum(keep) - 1).astype(np.int32)
    faces = surface.faces[keep[surface.faces[:, 0]]]
    return Surface(surface.positions[keep], renumbered[faces], surface.cell)
