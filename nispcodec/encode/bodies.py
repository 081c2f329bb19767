"""The bodies of an asset, sorted by the form that suits them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, IntArray
from nispcodec.core.connectivity import connected_faces
from nispcodec.core.document import Frame
from nispcodec.core.placing import placed_points
from nispcodec.encode.config import FormConfig
from nispcodec.geometry.shown import Shown
from nispcodec.geometry.welding import welded
from nispcodec.simplify.closest import Tree
from nispcodec.simplify.ladder import Candidate


@dataclass(frozen=True)
class Sorted:
    """The faces of an asset's mesh, sorted by body.

    dense       (m,) bool: of bodies that suit networks
    other       (m,) bool: of all others that can be seen
    dense_size  bytes that the dense ones take as triangles, about, ...
    other_size  ... and that the others take ...
    distance    ... at this mean distance, normalized frame
    sheets      whether some of the others are open surfaces
    """

    dense: BoolArray
    other: BoolArray
    dense_size: float
    other_size: float
    distance: float
    sheets: bool


def sort_bodies(seen: Shown, frame: Frame, candidate: Candidate, config: FormConfig) -> Sorted:
    """Sort the bodies of a mesh by what simplification makes of them.

    Where it leaves few of many faces a body is dense and smooth, which suits networks; sheets have
    no inside, and bodies of few bytes are not worth networks.
    """
    mesh = seen.mesh
    body = connected_faces(welded(mesh).positions)
    count = int(body.max()) + 1
    left, cost = _left(candidate, Tree(frame.to_normalized(mesh.corners)), body, count)
    size = cost * candidate.size / cost.sum()
    faces = np.bincount(body, seen.faces, count)
    sheet = np.bincount(body, seen.sheet & seen.faces, count) > faces / 2
    dense = ~sheet & (faces > config.dense * left) & (size > config.notable_body * candidate.size)
    return Sorted(
        dense=dense[body],
        other=(~dense & (faces > 0))[body],
        dense_size=float(size[dense].sum()),
        other_size=float(size[~dense].sum()),
        distance=candidate.errors.distance,
        sheets=bool((sheet & (faces > 0)).any()),
    )


def _left(
    candidate: Candidate, tree: Tree, body: IntArray, count: int
) -> tuple[Float64Array, Float64Array]:
    """By body, the triangles of a candidate, and those that are coded: copies share theirs."""
    left, cost = np.zeros((2, count))
    for part in candidate.parts:
        middles = part.normalized()[part.faces].mean(axis=1)
        for placement in part.placements:
            found = body[tree.closest(placed_points(placement, middles)).faces]
            triangles = np.bincount(found, minlength=count)
            left += triangles
            cost += triangles / len(part.placements)
    return left, cost
