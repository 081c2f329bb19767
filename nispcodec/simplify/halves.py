"""Triangles that are mirror images of each other: one half of them stands for both.

Cars, figures and furniture are often modeled as one half and its reflection. Where all faces are
kept, as many as have a mirror image, with UVs that are the same but for a shift or a reflection,
are held once and placed twice. The grid has the mirror's plane among its own, so that both halves
meet the rest without a gap.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from nispcodec.core.arrays import BoolArray, Int64Array
from nispcodec.core.connectivity import row_ids
from nispcodec.core.mesh_part import Placement
from nispcodec.simplify.config import CopiesConfig
from nispcodec.simplify.copies import Copies, Group
from nispcodec.simplify.mirror import Mirror
from nispcodec.simplify.triangles import Triangles

UV_SIGNS = ((1.0, 1.0), (-1.0, 1.0), (1.0, -1.0))


def with_halves(copies: Copies, planes: Sequence[Mirror], config: CopiesConfig) -> Copies | None:
    """Hold once the faces, of those that have no copies, that have a mirror image in a plane.

    By the plane with the most of them; None where that is too few to be worth a part of its own.
    """
    (plain, home), *others = copies.homes
    if len(plain.placements) > 1:
        return None
    found = [each for plane in planes for each in _alike(_Images(home, plane, config))]
    best = max(found, key=lambda each: int(each.held.sum()), default=None)
    if best is None or best.held.sum() < config.fewest:
        return None
    return Copies.of_homes([*best.groups(plain), *others], copies, best.mirror)


@dataclass(frozen=True)
class _Halves:
    """Which triangles are held for their reflections, and which are these.

    triangles  all of them; corners that a reflection has lie exactly where that puts them
    held, images  (m,) bool
    reflection    the placement of the images
    """

    triangles: Triangles
    mirror: Mirror
    held: BoolArray
    images: BoolArray
    reflection: Placement

    def groups(self, plain: Group) -> Iterator[tuple[Group, Triangles]]:
        """The faces that have no image, if any, and those held for theirs."""
        rest = ~(self.held | self.images)
        if rest.any():
            yield plain, self.triangles.only(rest)
        placements = Placement(), self.reflection
        both = replace(plain, placements=placements, materials=(None, None))
        yield both, self.triangles.only(self.held)


@dataclass(frozen=True)
class _Images:
    """What a mirror makes of triangles."""

    triangles: Triangles
    mirror: Mirror
    config: CopiesConfig

    @cached_property
    def vertices(self) -> Int64Array:
        """(n,): the vertex at each one's reflection; -1 for none."""
        positions = self.triangles.positions
        apart, found = cKDTree(positions).query(self.mirror.image(positions))
        return np.where(apart <= self.config.tolerance, found, -1)

    @cached_property
    def faces(self) -> Int64Array:
        """(m,): the face, of another place but the same kind, at each one's reflection; or -1."""
        triangles, count = self.triangles, len(self.triangles)
        corners = self.vertices[triangles.faces]
        keys = row_ids(np.sort(np.concatenate([triangles.faces, corners]), axis=1))
        owners = np.full(int(keys.max()) + 1, -1, np.int64)
        owners[keys[:count]] = np.arange(count)
        found = owners[keys[count:]]
        kinds = np.stack([triangles.materials, triangles.has_uv, triangles.sheet], axis=1)
        alike = (kinds == kinds[found]).all(axis=1) & (found != np.arange(count))
        found = np.where(alike & (corners >= 0).all(axis=1), found, -1)
        found[found >= 0] = np.where(self._looks_out(found), found, -1)[found >= 0]
        return np.where(found[found] == np.arange(count), found, -1)

    @cached_property
    def _corners(self) -> Int64Array:
        """(m, 3): which corner of its image each corner of a face is, where there is one."""
        own = np.argsort(self.vertices[self.triangles.faces], axis=1)
        return np.asarray(np.argsort(own, axis=1))

    def corners(self, images: Int64Array) -> Int64Array:
        """(m, 3): the corners, from 0 to 2, of the images (m,) that those of each face have."""
        order = np.argsort(self.triangles.faces[images], axis=1)
        return np.take_along_axis(order, self._corners, axis=1)

    def _looks_out(self, images: Int64Array) -> BoolArray:
        """(m,): whether the images (m,) are wound as reflections are."""
        corners = self.corners(images)
        return np.asarray((corners[:, 1] - corners[:, 0]) % 3 == 2)


def _alike(images: _Images) -> Iterator[_Halves]:
    """The halves that each sort of reflection of UVs leaves, if any."""
    triangles, mirror = images.triangles, images.mirror
    middles = triangles.corners.mean(axis=1)[:, mirror.axis]
    chosen = np.flatnonzero((images.faces >= 0) & (middles > middles[images.faces]))
    if len(chosen) < images.config.fewest:
        return
    corners = images.corners(np.maximum(images.faces, 0))[chosen]
    there = triangles.corner_uvs[images.faces[chosen]]
    there = np.take_along_axis(there, corners[:, :, None], axis=1)
    bare = ~triangles.has_uv[chosen]
    for scale in UV_SIGNS:
        offsets = there - triangles.corner_uvs[chosen] * scale
        offset = np.zeros(2) if bare.all() else np.median(offsets[~bare].reshape(-1, 2), axis=0)
        off = np.abs(offsets - offset).max(axis=(1, 2))
        held = chosen[bare | (off <= images.config.uv_tolerance)]
        yield _halves(images, held, mirror.placement(scale, (float(offset[0]), float(offset[1]))))


def _halves(images: _Images, chosen: Int64Array, reflection: Placement) -> _Halves:
    """chosen: (k,) the numbers of the faces that are held."""
    triangles, mirror = images.triangles, images.mirror
    held, shown = np.zeros((2, len(triangles)), np.bool_)
    held[chosen] = shown[images.faces[chosen]] = True
    # A vertex of the plane is its own image.
    moved = np.unique(triangles.faces[held])
    own = images.vertices[moved] == moved
    positions = triangles.positions.copy()
    positions[moved[own], mirror.axis] = mirror.at
    positions[images.vertices[moved[~own]]] = mirror.image(positions[moved[~own]])
    return _Halves(replace(triangles, positions=positions), mirror, held, shown, reflection)
