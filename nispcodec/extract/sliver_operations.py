"""The operations that take slivers away, many at a time, and which of them go together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, FloatArray, Int64Array
from nispcodec.extract.config import SliverConfig
from nispcodec.extract.wedges import Wedges


@dataclass(frozen=True)
class Shapes:
    """Where vertices are (n, 3), and the field's unit normals there (n, 3)."""

    positions: Float64Array
    normals: Float64Array
    config: SliverConfig

    @staticmethod
    def of(positions: FloatArray, gradients: FloatArray, config: SliverConfig) -> Shapes:
        """From gradients (n, 3) of any length."""
        lengths = np.linalg.norm(gradients, axis=1, keepdims=True)
        normals = gradients.astype(np.float64) / np.maximum(lengths, 1e-12)
        return Shapes(positions.astype(np.float64), normals, config)

    def with_more(self, others: Shapes) -> Shapes:
        """These vertices, and after them those of another."""
        positions = np.concatenate([self.positions, others.positions])
        return Shapes(positions, np.concatenate([self.normals, others.normals]), self.config)

    def badness(self, faces: Int64Array) -> Float64Array:
        """Square of the longest side over the area seen along the normal, of each face (m, 3).

        2.3 at best; `SliverConfig.turned` at most, and where that area is not above 0. The whole
        area counts where normals tell less than `SliverConfig.told`.
        """
        a, b, c = (self.positions[faces[:, corner]] for corner in range(3))
        ab, bc, ca = b - a, c - b, a - c
        longest = np.maximum(np.maximum(_squares(ab), _squares(bc)), _squares(ca))
        normals = self.normals[faces[:, 0]] + self.normals[faces[:, 1]] + self.normals[faces[:, 2]]
        lengths, across = np.sqrt(_squares(normals)), np.cross(ca, ab)
        along = _dots(across, normals) / (2 * np.maximum(lengths, 1e-12))
        told = lengths >= 3 * self.config.told
        seen = np.where(told, along, np.sqrt(_squares(across)) / 2)
        most = self.config.turned
        return np.where(seen * most > longest, longest / np.maximum(seen, 1e-300), most)

    def give(self, faces: Int64Array) -> Float64Array:
        """How far the surface may move to mend what lies in each face (m, 3)."""
        corners = self.positions[faces]
        sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
        return self.config.give * sides.max(axis=1)


@dataclass(frozen=True)
class Collapses:
    """Vertices (k,) that others (k,) replace, what that gains, and whom it concerns.

    owners, claims  (j,) numbers of collapses, and a vertex that nothing else may change
    """

    removed: Int64Array
    target: Int64Array
    gain: Float64Array
    owners: Int64Array
    claims: Int64Array

    def joined(self, others: Collapses) -> Collapses:
        """These, and after them others."""
        return Collapses(
            np.concatenate([self.removed, others.removed]),
            np.concatenate([self.target, others.target]),
            np.concatenate([self.gain, others.gain]),
            np.concatenate([self.owners, others.owners + len(self.removed)]),
            np.concatenate([self.claims, others.claims]),
        )


@dataclass(frozen=True)
class Flips:
    """Faces by their rows (k, 2), what takes their place (k, 2, 3), what that gains, claims."""

    rows: Int64Array
    faces: Int64Array
    gain: Float64Array

    @property
    def claims(self) -> Int64Array:
        """(k, 4): the vertices that nothing else may change."""
        return np.concatenate([self.faces[:, 0], self.faces[:, 1, 1:2]], axis=1)


def collapses(shapes: Shapes, wedges: Wedges, sides: Int64Array) -> Collapses:
    """Those of the half-edges `sides` (s,), either way, that make things better."""
    both = np.concatenate([sides, wedges.twins[sides]])
    both = both[both >= 0]
    return replacements(shapes, wedges, both, wedges.ends[both])


def replacements(
    shapes: Shapes, wedges: Wedges, half_edges: Int64Array, target: Int64Array
) -> Collapses:
    """Those of the vertices that half-edges (s,) start at which are better replaced by `target`.

    target: (s,) the half-edges' ends, or vertices of no face yet.
    """
    removed, count = wedges.starts[half_edges], len(half_edges)
    owners, ring = wedges.around(removed)
    before = wedges.faces[ring // 3]
    after = np.where(before == removed[owners, None], target[owners, None], before)
    goes = (before == target[owners, None]).any(axis=1)
    old, new = shapes.badness(before), np.where(goes, 0, shapes.badness(after))
    least = shapes.config.worth * np.bincount(owners, old**2, minlength=count)
    gain = np.bincount(owners, old**2 - new**2, minlength=count).astype(np.float64)
    give, lifted = np.zeros(count), np.zeros(count)
    np.maximum.at(give, owners, shapes.give(before))
    np.maximum.at(lifted, owners, _lifts(shapes, before, removed[owners], target[owners], old))
    kept = _keeps_borders(shapes, wedges, half_edges, target, owners, ring, give)
    linked = wedges.linked(wedges.ends[ring], target[owners])
    shared = np.bincount(owners, linked, minlength=count)
    sound = (shared == 2) | (target != wedges.ends[half_edges])
    better = np.flatnonzero(kept & sound & (gain > least) & (lifted <= give))
    return _chosen(Collapses(removed, target, gain, owners, wedges.ends[ring]), better)


def _lifts(
    shapes: Shapes, faces: Int64Array, removed: Int64Array, target: Int64Array, bad: Float64Array
) -> Float64Array:
    """How far off the plane of each face (r, 3) a vertex goes; 0 for faces that are no shape."""
    a, b, c = shapes.positions[faces].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    lengths = np.maximum(np.linalg.norm(normals, axis=1), 1e-300)
    step = shapes.positions[target] - shapes.positions[removed]
    return np.where(bad > shapes.config.aspect, 0.0, np.abs(_dots(normals, step)) / lengths)


def _keeps_borders(
    shapes: Shapes,
    wedges: Wedges,
    half_edges: Int64Array,
    target: Int64Array,
    owners: Int64Array,
    ring: Int64Array,
    give: Float64Array,
) -> BoolArray:
    """Whether the borders of charts stay where they are when half-edges' starts go to `target`.

    A vertex within a chart is free; one on a border goes along it, if that is straight enough, or
    to another vertex as near as `SliverConfig.stray`; one where the surface ends stays. owners,
    ring: the half-edges that leave each.
    """
    removed, count = wedges.starts[half_edges], len(half_edges)
    ends = np.bincount(owners, wedges.twins[ring] < 0, minlength=count) > 0
    border = wedges.border[ring]
    meeting = np.bincount(owners, border, minlength=count)
    # Where two border edges leave a vertex, the sum of their ends tells the other one's.
    sums = np.bincount(owners, np.where(border, wedges.ends[ring], 0), minlength=count)
    along = (meeting == 2) & wedges.border[half_edges]
    beyond = np.where(along, sums.astype(np.int64) - wedges.ends[half_edges], target)
    start, end = shapes.positions[target], shapes.positions[beyond]
    strays = _distances(shapes.positions[removed], start, end) > give
    step = np.linalg.norm(start - shapes.positions[removed], axis=1)
    near = step * shapes.config.give <= give * shapes.config.stray
    beside = near & (target == wedges.ends[half_edges])
    return ~ends & ((meeting == 0) | (along & ~strays) | beside)


def _chosen(found: Collapses, better: Int64Array) -> Collapses:
    """Some collapses, with the vertices themselves among the claims."""
    numbers = np.full(len(found.removed), -1)
    numbers[better] = np.arange(len(better))
    kept = numbers[found.owners] >= 0
    removed, target = found.removed[better], found.target[better]
    every = np.arange(len(better))
    return Collapses(
        removed,
        target,
        found.gain[better],
        np.concatenate([numbers[found.owners[kept]], every, every]),
        np.concatenate([found.claims[kept], removed, target]),
    )


def flips(shapes: Shapes, wedges: Wedges, sides: Int64Array) -> Flips:
    """Those of the half-edges `sides` (s,) whose faces are better with the other diagonal."""
    sides = sides[(wedges.twins[sides] >= 0) & ~wedges.border[sides]]
    twins = wedges.twins[sides]
    a, b = wedges.starts[sides], wedges.ends[sides]
    c, d = (wedges.ends[_following(each)] for each in (sides, twins))
    rows = np.stack([sides // 3, twins // 3], axis=1)
    faces = np.stack([np.stack([a, d, c], axis=1), np.stack([d, b, c], axis=1)], axis=1)
    old = shapes.badness(wedges.faces[rows.ravel()]).reshape(-1, 2)
    new = shapes.badness(faces.reshape(-1, 3)).reshape(-1, 2)
    gain = (old**2 - new**2).sum(axis=1)
    give = shapes.give(wedges.faces[rows.ravel()]).reshape(-1, 2).max(axis=1)
    flat = _apart(*(shapes.positions[each] for each in (a, b, c, d))) <= give
    better = (gain > 0) & (c != d) & flat & ~wedges.linked(c, d)
    return Flips(rows[better], faces[better], gain[better])


def independent(down: Collapses, turned: Flips, count: int) -> tuple[Collapses, Flips]:
    """The operations on `count` vertices that concern none of a better one's."""
    gains = np.concatenate([down.gain, turned.gain])
    ranks = np.empty(len(gains), np.int64)
    ranks[np.argsort(-gains, kind="stable")] = np.arange(len(gains))
    flipping = np.repeat(np.arange(len(turned.gain)), 4) + len(down.gain)
    owners = np.concatenate([down.owners, flipping])
    claims = np.concatenate([down.claims, turned.claims.ravel()])
    first = np.full(count, len(gains))
    np.minimum.at(first, claims, ranks[owners])
    wins = np.bincount(owners, first[claims] != ranks[owners], minlength=len(gains)) == 0
    chosen, flipped = np.flatnonzero(wins[: len(down.gain)]), wins[len(down.gain) :]
    return (
        _chosen(down, chosen),
        Flips(turned.rows[flipped], turned.faces[flipped], turned.gain[flipped]),
    )


def _following(half_edges: Int64Array) -> Int64Array:
    """The next half-edge of the same face."""
    return half_edges - half_edges % 3 + (half_edges + 1) % 3


def _squares(vectors: Float64Array) -> Float64Array:
    return _dots(vectors, vectors)


def _dots(one: Float64Array, other: Float64Array) -> Float64Array:
    return np.einsum("ij,ij->i", one, other)


def _distances(points: Float64Array, start: Float64Array, end: Float64Array) -> Float64Array:
    """How far points (k, 3) are from segments."""
    along = end - start
    share = _dots(points - start, along) / np.maximum(_squares(along), 1e-300)
    nearest = start + np.clip(share, 0, 1)[:, None] * along
    return np.linalg.norm(points - nearest, axis=1)


def _apart(a: Float64Array, b: Float64Array, c: Float64Array, d: Float64Array) -> Float64Array:
    """Distances (k,) between the lines a b and c d."""
    across = np.cross(b - a, d - c)
    lengths = np.linalg.norm(across, axis=1)
    return np.abs(_dots(c - a, across)) / np.maximum(lengths, 1e-300)
