"""Taking needles, caps and turned faces out of a simplified surface.

A face is as bad as the square of its longest side over its area, the area as seen along the field's
normal: that bounds its aspect and its turn at once. Around each bad face edges are collapsed or
flipped, the best first, where all faces around get better together (after Botsch and Kobbelt,
"A Robust Procedure to Eliminate Degenerate Faces from Triangle Meshes", 2001). Where neither helps,
vertices slide a part of the way along an edge, which leaves the surface where it is just as well.
A face that nothing helps is given up until something changes beside it. What is left then may move
borders between charts a little, and in thin walls, where normals tell no side, shape alone counts.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from nispcodec.core.arrays import BoolArray, Int32Array, Int64Array
from nispcodec.core.network import Network
from nispcodec.extract.config import SliverConfig
from nispcodec.extract.isosurface import Surface
from nispcodec.extract.sliver_operations import (
    Collapses,
    Flips,
    Shapes,
    collapses,
    flips,
    independent,
    replacements,
)
from nispcodec.extract.wedges import Wedges
from nispcodec.infer.evaluate import gradient


def without_slivers(
    network: Network, surface: Surface, charts: Int32Array, config: SliverConfig = SliverConfig()
) -> tuple[Surface, Int32Array]:
    """The surface with better faces, and their charts: `charts` (m,) are those of its faces.

    Vertices stay, go, or slide along an edge. Borders between charts keep their course but at the
    last faces that nothing else helps, the edge of an open surface stays.
    """
    for how in (replace(config, told=0.0, stray=0.0), config):
        surface, charts = _mended(network, surface, charts, how)
    return surface, charts


def _mended(
    network: Network, surface: Surface, charts: Int32Array, config: SliverConfig
) -> tuple[Surface, Int32Array]:
    shapes = Shapes.of(surface.positions, gradient(network, surface.positions)[1], config)
    faces = surface.faces.astype(np.int64)
    patch = Patch(faces, charts, shapes.badness(faces) > config.aspect)
    for _ in range(config.rounds):
        before = patch
        shapes, patch = _improved(network, shapes, patch)
        if patch is before:
            break
    used, corners = np.unique(patch.faces, return_inverse=True)
    renumbered = corners.reshape(-1, 3).astype(np.int32)
    positions = shapes.positions[used].astype(np.float32)
    return Surface(positions, renumbered, surface.cell), patch.charts


@dataclass(frozen=True)
class Patch:
    """faces (m, 3), the chart of each (m,), and which are bad and not given up (m,)."""

    faces: Int64Array
    charts: Int32Array
    bad: BoolArray


def _improved(network: Network, shapes: Shapes, patch: Patch) -> tuple[Shapes, Patch]:
    """One round; the same patch where nothing helps."""
    touched = np.zeros(len(shapes.positions), np.bool_)
    touched[patch.faces[patch.bad]] = True
    near = np.flatnonzero(touched[patch.faces].any(axis=1))
    wedges = Wedges.of(patch.faces[near], patch.charts[near])
    sides = (3 * np.flatnonzero(patch.bad[near])[:, None] + np.arange(3)).ravel()
    down, turned = collapses(shapes, wedges, sides), flips(shapes, wedges, sides)
    idle = ~_concerned(down, turned, len(shapes.positions))[patch.faces[patch.bad]].any(axis=1)
    shapes, slid = _slid(network, shapes, wedges, np.unique(patch.faces[patch.bad][idle]))
    down = down.joined(slid)
    if not len(down.removed) + len(turned.rows):
        return shapes, patch
    concerned = _concerned(down, turned, len(shapes.positions))
    down, turned = independent(down, turned, len(shapes.positions))
    return shapes, _changed(shapes, patch, near, down, turned, concerned)


def _concerned(down: Collapses, turned: Flips, count: int) -> BoolArray:
    """Which of `count` vertices operations concern."""
    concerned = np.zeros(count, np.bool_)
    concerned[down.claims] = True
    concerned[turned.claims] = True
    return concerned


def _slid(
    network: Network, shapes: Shapes, wedges: Wedges, vertices: Int64Array
) -> tuple[Shapes, Collapses]:
    """With new vertices on the edges around some, and those of them that are better places."""
    _, half_edges = wedges.around(vertices)
    half_edges = np.repeat(half_edges, len(shapes.config.slides))
    shares = np.resize(shapes.config.slides, len(half_edges))[:, None]
    start, end = (shapes.positions[each[half_edges]] for each in (wedges.starts, wedges.ends))
    places = (start + shares * (end - start)).astype(np.float32)
    new = Shapes.of(places, gradient(network, places)[1], shapes.config)
    more = shapes.with_more(new)
    numbers = len(shapes.positions) + np.arange(len(places))
    return more, replacements(more, wedges, half_edges, numbers)


def _changed(
    shapes: Shapes,
    patch: Patch,
    near: Int64Array,
    down: Collapses,
    turned: Flips,
    concerned: BoolArray,
) -> Patch:
    """After operations on the faces `near`; bad ones without a vertex `concerned` are given up."""
    goes_to = np.arange(len(shapes.positions))
    goes_to[down.removed] = down.target
    after = patch.faces[near]
    after[turned.rows] = turned.faces
    after = goes_to[after]
    faces, bad = patch.faces.copy(), patch.bad.copy()
    faces[near] = after
    bad[near] = concerned[after].any(axis=1) & (shapes.badness(after) > shapes.config.aspect)
    kept = np.ones(len(faces), np.bool_)
    kept[near] = (after != np.roll(after, 1, axis=1)).all(axis=1)
    return Patch(faces[kept], patch.charts[kept], bad[kept])
