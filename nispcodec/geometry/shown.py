"""The faces of a mesh that can be seen from outside, turned as their bodies are."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.connectivity import connected_faces, edge_ids
from nispcodec.geometry.analysis import Analysis
from nispcodec.geometry.config import SolidConfig
from nispcodec.geometry.rays import leaves, ways_beside
from nispcodec.geometry.triangles import area, normals
from nispcodec.geometry.welding import welded


@dataclass(frozen=True)
class Shown:
    """An asset's mesh, world frame, and which of its faces a file has to hold.

    mesh   the asset's, faces wound the wrong way within their body turned
    faces  (m,) bool: what is not hidden, or is inside another body and seen for all that, through
           an opening of it: no signed distance can hold those, but triangles can; and hidden faces
           beside two others, as jagged borders take more bytes than they do
    inner  (m,) bool: those inside another body that are seen through an opening
    sheet  (m,) bool: open surfaces, which have no inside
    """

    mesh: TexturedMesh
    faces: BoolArray
    inner: BoolArray
    sheet: BoolArray


def shown(analysis: Analysis) -> Shown:
    """The faces as an analysis has them: the pieces of its solid tell."""
    mesh, solid, config = analysis.mesh, analysis.solid, analysis.config.solid
    count = len(mesh.faces)
    own = normals(mesh.corners)[solid.parents]
    against = np.einsum("nk,nk->n", own, solid.normals) < 0
    turned = _any(solid.parents[against], count)
    sheet = _any(solid.parents[solid.open_surface], count)
    walls = _any(solid.parents[solid.wall & ~solid.open_surface], count)
    flipped = replace(
        mesh,
        faces=np.where(turned[:, None], mesh.faces[:, ::-1], mesh.faces),
        uv_faces=np.where(turned[:, None], mesh.uv_faces[:, ::-1], mesh.uv_faces),
        creases=_turned(mesh.creases, turned),
    )
    faces, inner = _any(solid.parents, count), np.zeros(count, np.bool_)
    hidden = np.flatnonzero(~faces)
    inner[hidden] = _seen(analysis.frame.to_normalized(mesh.corners), hidden, config)
    faces |= inner
    faces |= _beside_two(welded(flipped).positions, faces)
    return Shown(flipped, faces, inner, _by_body(flipped, faces, sheet & ~walls))


def _turned(creases: BoolArray | None, turned: BoolArray) -> BoolArray | None:
    """Of faces whose corners are in the reverse order: the side that was first is second."""
    if creases is None:
        return None
    return np.where(turned[:, None], creases[:, [1, 0, 2]], creases)


def _seen(corners: Float64Array, faces: Int64Array, config: SolidConfig) -> BoolArray:
    """Which of some faces (k,) of a mesh (m, 3, 3) a ray from a random point of them leaves."""
    random = np.random.default_rng(0)
    rays = min(max(config.sight_rays // max(len(faces), 1), config.few_rays), config.many_rays)
    asked = np.repeat(corners[faces], rays, axis=0)
    weights = random.dirichlet(np.ones(3), len(asked))
    side = np.where(random.random(len(asked)) < 0.5, 1.0, -1.0)[:, None]
    facing = side * normals(asked)
    start = np.einsum("nk,nkd->nd", weights, asked) + config.sight_offset * facing
    free = leaves(corners, start, ways_beside(facing, random))
    return np.asarray(free.reshape(len(faces), rays).any(axis=1))


def _beside_two(corners: Int64Array, chosen: BoolArray) -> BoolArray:
    """(m,): which faces, of corners (m, 3), have chosen ones (m,) over two sides or three."""
    sides = edge_ids(corners)[0].reshape(-1, 3)
    among = np.zeros(int(sides.max()) + 1, np.bool_)
    among[sides[chosen]] = True
    return np.asarray(among[sides].sum(axis=1) >= 2)


def _by_body(mesh: TexturedMesh, faces: BoolArray, sheet: BoolArray) -> BoolArray:
    """Bodies (of the faces that are left) are sheets as a whole, when most of their area is."""
    chosen = np.flatnonzero(faces)
    bodies = connected_faces(welded(mesh).positions[chosen])
    areas = area(mesh.corners[chosen])
    most = np.bincount(bodies, areas * sheet[chosen]) > np.bincount(bodies, areas) / 2
    found = np.zeros(len(faces), np.bool_)
    found[chosen] = most[bodies]
    return found


def _any(faces: np.ndarray, count: int) -> BoolArray:
    found = np.zeros(count, np.bool_)
    found[faces] = True
    return found
