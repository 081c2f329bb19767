"""Which pieces of an extracted surface are real, and which are noise of the fitted field.

A fitted SDF may cross zero where there is no surface, far from its training samples. Such a
crossing gives itself away: it lies outside the normalized frame's unit ball, or the field around it
is no distance field and it is steep, or tiny and far from everything else. Tiny pieces beside
others are what is left of straps and wires, but for crumbs of a single cell. A small hollow that
nothing leads into is dropped as well: nobody can see into it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from nispcodec.core.arrays import BoolArray, Float32Array, Float64Array, Int32Array, Int64Array
from nispcodec.core.network import Network
from nispcodec.extract.grid import LIMIT
from nispcodec.extract.isosurface import OUTSIDE, Surface
from nispcodec.infer.evaluate import gradient

# Slopes are relative to the whole surface's. Noise between the samples was seen at 3 to 7. Flat
# pieces are mostly scraps of real detail that the fit could not hold: only lonely specks are
# dropped.
STEEP, SMALL_SHARE = 1.7, 0.05
FLAT, SPECK_AREA, LONELY = 0.6, 3e-3, 0.02
# Vertices of a flat piece about one cell, of which the grid tells no shape: meshes go without. Rays
# do not, as what is left out for them is left out by larger cells.
CRUMB = 8
# Vertices of which one is near any place on the surface, a quarter of `LONELY` or less away.
MANY = 200_000
HOLLOW_SHARE = 0.03
SOME = 20_000


@dataclass(frozen=True)
class ExtractionReport:
    """What was extracted: cells along the cube's edge, connected components, dropped noise."""

    resolution: int
    kept: int
    dropped: int
    dropped_faces: int

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the user of the mesh should know: a sentence when something was dropped."""
        if not self.dropped:
            return ()
        return (f"{self.dropped} spurious component(s), {self.dropped_faces} faces, dropped",)


def without_noise(
    network: Network, surface: Surface, keep: bool = False
) -> tuple[Surface, ExtractionReport]:
    """The surface without spurious components, unless they are to be kept, and the counts."""
    unwanted, labels = spurious(network, surface)
    unwanted |= _crumbs(network, surface, labels, len(unwanted))
    if keep:
        unwanted[:] = False
    cleaned = without(surface, unwanted, labels)
    report = ExtractionReport(
        resolution=round(2 * LIMIT / surface.cell),
        kept=int((~unwanted).sum()),
        dropped=int(unwanted.sum()),
        dropped_faces=len(surface.faces) - len(cleaned.faces),
    )
    return cleaned, report


def components(surface: Surface) -> tuple[int, Int32Array]:
    """How many connected components, and the component of each vertex (n,)."""
    a, b = surface.faces[:, :2].T, surface.faces[:, 1:].T
    rows, columns = np.concatenate([a[0], a[1]]), np.concatenate([b[0], b[1]])
    size = len(surface.positions)
    graph = coo_array((np.ones(len(rows), np.bool_), (rows, columns)), shape=(size, size))
    count, labels = connected_components(graph, directed=False)
    return count, labels.astype(np.int32)


def spurious(network: Network, surface: Surface) -> tuple[BoolArray, Int32Array]:
    """Which components are noise (c,) bool, and the component of each vertex (n,).

    A component is noise when all of it lies outside the unit ball, when it is small and the field
    is steep on it, when it is a lonely speck and the field is flat, or when it is a small hollow.
    """
    count, labels = components(surface)
    if count < 2:
        return np.zeros(count, np.bool_), labels
    nearest = np.full(count, np.inf)
    np.minimum.at(nearest, labels, np.linalg.norm(surface.positions, axis=1))
    vertices = np.bincount(labels, minlength=count)
    slope = _mean_slopes(network, surface, labels, vertices)
    flat = _lonely(surface, labels, (slope < FLAT) & (vertices * surface.cell**2 < SPECK_AREA))
    hollow = _volumes(surface, labels, vertices < HOLLOW_SHARE * len(labels)) < 0
    return (nearest > OUTSIDE) | (slope > STEEP) | flat | hollow, labels


def _crumbs(network: Network, surface: Surface, labels: Int32Array, count: int) -> BoolArray:
    """Which of several components (c,) bool are flat and of a single cell."""
    vertices = np.bincount(labels, minlength=count)
    crumbs: BoolArray = (vertices <= CRUMB) & (count > 1)
    if crumbs.any():
        crumbs &= _mean_slopes(network, surface, labels, vertices) < FLAT
    return crumbs


def _lonely(surface: Surface, labels: Int32Array, specks: BoolArray) -> BoolArray:
    """Of some components (c,) bool those with no other component within `LONELY`."""
    apart = specks[labels]
    members, points = labels[apart], surface.positions[apart]
    others = surface.positions[~apart]
    others = others[:: 1 + len(others) // MANY]
    near = np.isfinite(KDTree(others).query(points, distance_upper_bound=LONELY)[0])
    counts = np.maximum(np.bincount(members, minlength=len(specks)), 1)
    sums = [np.bincount(members, axis, len(specks)) for axis in points.T]
    centers = np.stack(sums, axis=1)[specks] / counts[specks, None]
    # The nearest center is a speck's own.
    gaps = KDTree(centers).query(centers, k=2)[0][:, 1]
    lonely = specks.copy()
    lonely[members[near]] = False
    lonely[np.flatnonzero(specks)[gaps <= LONELY]] = False
    return lonely


def _volumes(surface: Surface, labels: Int32Array, small: BoolArray) -> Float64Array:
    """What each small closed component encloses; below 0 when its outside is within (Gauss)."""
    faces = surface.faces[small[labels[surface.faces[:, 0]]]]
    a, b, c = np.moveaxis(surface.positions[faces].astype(np.float64), 1, 0)
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6
    return np.bincount(labels[faces[:, 0]], volume, len(small)).astype(np.float64)


def _mean_slopes(
    network: Network, surface: Surface, labels: Int32Array, vertices: Int64Array
) -> Float64Array:
    """Mean slope of the field on each small component, relative to the whole; 1 on large ones."""
    small = vertices < SMALL_SHARE * len(labels)
    chosen = np.flatnonzero(small[labels])
    totals = np.bincount(labels[chosen], _slopes(network, surface, chosen), minlength=len(small))
    some = np.arange(0, len(labels), 1 + len(labels) // SOME)
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
