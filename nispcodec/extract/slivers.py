"""Taking needles, caps and turned faces out of a simplified surface.

A face is as bad as the square of its longest side over its area, the area as seen along the field's
normal: that bounds its aspect and its turn at once. Around each bad face edges are collapsed or
flipped, the best first, where all faces around get better together (after Botsch and Kobbelt,
"A Robust Procedure to Eliminate Degenerate Faces from Triangle Meshes", 2001).
"""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import BoolArray, Int32Array, Int64Array
from nispcodec.core.network import Network
from nispcodec.extract.config import SliverConfig
from nispcodec.extract.isosurface import Surface
from nispcodec.extract.sliver_operations import Shapes, collapses, flips, independent
from nispcodec.extract.wedges import Wedges
from nispcodec.infer.evaluate import gradient


def without_slivers(
    network: Network, surface: Surface, charts: Int32Array, config: SliverConfig = SliverConfig()
) -> tuple[Surface, Int32Array]:
    """The surface with better faces, and their charts: `charts` (m,) are those of its faces.

    Vertices stay where they are, or go. Borders between charts keep their course, the edge of an
    open surface stays.
    """
    shapes = Shapes.of(surface.positions, gradient(network, surface.positions)[1], config)
    faces = surface.faces.astype(np.int64)
    bad = shapes.badness(faces) > config.aspect
    for _ in range(config.rounds):
        before = faces
        faces, charts, bad = _improved(shapes, faces, charts, bad)
        if faces is before:
            break
    used, corners = np.unique(faces, return_inverse=True)
    renumbered = corners.reshape(-1, 3).astype(np.int32)
    return Surface(surface.positions[used], renumbered, surface.cell), charts


def _improved(
    shapes: Shapes, faces: Int64Array, charts: Int32Array, bad: BoolArray
) -> tuple[Int64Array, Int32Array, BoolArray]:
    """Faces, their charts and which are bad after one round; the same array where none helps."""
    touched = np.zeros(len(shapes.positions), np.bool_)
    touched[faces[bad]] = True
    near = np.flatnonzero(touched[faces].any(axis=1))
    wedges = Wedges.of(faces[near], charts[near])
    sides = (3 * np.flatnonzero(bad[near])[:, None] + np.arange(3)).ravel()
    down, turned = collapses(shapes, wedges, sides), flips(shapes, wedges, sides)
    down, turned = independent(down, turned, len(touched))
    if not len(down.removed) + len(turned.rows):
        return faces, charts, bad
    goes_to = np.arange(len(touched))
    goes_to[down.removed] = down.target
    after = faces[near]
    after[turned.rows] = turned.faces
    after = goes_to[after]
    faces, bad = faces.copy(), bad.copy()
    faces[near], bad[near] = after, shapes.badness(after) > shapes.config.aspect
    kept = np.ones(len(faces), np.bool_)
    kept[near] = (after != np.roll(after, 1, axis=1)).all(axis=1)
    return faces[kept], charts[kept], bad[kept]
