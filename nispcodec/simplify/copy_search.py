"""Which bodies are copies of others: turned, scaled, reflected, with other UVs and materials.

Copies in a file have their faces in the same order: corner for corner, a similarity is fitted, and
checked at every corner. The corners of a face may begin with another, and go the other way around
where the copy is a reflection.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from nispcodec.core.arrays import BoolArray, Int32Array, Int64Array
from nispcodec.core.connectivity import row_ids
from nispcodec.core.mesh_part import Placement
from nispcodec.simplify.body import Body, placement_of
from nispcodec.simplify.config import CopiesConfig
from nispcodec.simplify.copies import Copies, Group
from nispcodec.simplify.triangles import Triangles

KEPT = ((0, 1, 2), (1, 2, 0), (2, 0, 1))
TURNED = ((0, 2, 1), (2, 1, 0), (1, 0, 2))


def copies_of(triangles: Triangles, config: CopiesConfig, kept: BoolArray | None = None) -> Copies:
    """Bodies that are copies stand for each other; the largest is the one that is held.

    kept: (m,) bool, the faces that have to be held; None: all. Bodies are compared with all their
    faces: what other bodies hide is not the same of every copy. Of a body that is held, every face
    is that has to be in any copy.
    """
    kept = np.ones(len(triangles), np.bool_) if kept is None else kept
    spread = replace(triangles, sheet=_spread(triangles, kept))
    families = [
        family
        for alike in _alike(spread, kept, config.fewest)
        for family in _families(alike, config)
        if family.saves(kept) >= config.fewest * (len(family.copies) - 1) > 0
    ]
    return (
        _held(spread, kept, families, config.fewest_left)
        if families
        else Copies.none(triangles, kept)
    )


def _spread(triangles: Triangles, kept: BoolArray) -> BoolArray:
    """(m,) bool: the faces of sheets, where those that are not kept are as most of their body."""
    bodies = triangles.bodies
    most = 2 * np.bincount(bodies, kept & triangles.sheet) > np.bincount(bodies, kept)
    return np.where(kept, triangles.sheet, most[bodies])


@dataclass(frozen=True)
class _Family:
    """A body and all that are copies of it, corner for corner, itself among them."""

    body: Body
    copies: list[tuple[Body, Placement]]

    def held(self, kept: BoolArray) -> BoolArray:
        """(k,) bool: the faces of the body that are kept in any copy, by all that are (m,) bool."""
        return np.any([kept[copy.faces] for copy, _ in self.copies], axis=0)

    def saves(self, kept: BoolArray) -> int:
        """How many faces less there are than without the family."""
        return sum(int(kept[copy.faces].sum()) for copy, _ in self.copies) - int(
            self.held(kept).sum()
        )

    def group(self, patches: Int64Array, own: range) -> Group:
        """patches (k,): the number of the patch of each face, -1 of those not held; own: these."""
        tables: list[Int32Array] = []
        for copy, _ in self.copies:
            table = np.zeros(len(own), np.int32)
            held = patches >= 0
            table[patches[held] - own.start] = copy.triangles.materials[copy.faces[held]]
            tables.append(table)
        return Group(
            patches=own,
            placements=tuple(placement for _, placement in self.copies),
            materials=tuple(None if (each == tables[0]).all() else each for each in tables),
        )


def _alike(triangles: Triangles, kept: BoolArray, fewest: int) -> Iterator[list[Body]]:
    """Lists of bodies with as many faces, with UVs and of sheets, some kept; large bodies first."""
    bodies = triangles.bodies
    order, counts = np.argsort(bodies, kind="stable"), np.bincount(bodies)
    kinds = np.bincount(bodies, triangles.has_uv), np.bincount(bodies, triangles.sheet)
    numbers = row_ids(np.stack([counts, *kinds], axis=1))
    found: dict[int, list[Body]] = {}
    for number, faces in zip(numbers, np.split(order, np.cumsum(counts)[:-1]), strict=True):
        if kept[faces].sum() >= fewest:
            found.setdefault(int(number), []).append(Body.of(triangles, faces))
    for alike in found.values():
        if len(alike) > 1:
            yield sorted(alike, key=lambda body: -body.size)


def _families(bodies: list[Body], config: CopiesConfig) -> list[_Family]:
    """Each body with the first one that it is a copy of."""
    families: list[_Family] = []
    for body in bodies:
        similar = [each for each in families if _close(each.body.shape, body.shape, config.alike)]
        for family in similar[: config.most_tried]:
            found = _copy(family.body, body, config)
            if found is not None:
                family.copies.append(found)
                break
        else:
            families.append(_Family(body, [(body, Placement())]))
    return families


def _close(one: float, other: float, share: float) -> bool:
    return abs(one - other) <= share * max(one, other)


def _copy(body: Body, copy: Body, config: CopiesConfig) -> tuple[Body, Placement] | None:
    for order in (*KEPT, *TURNED):
        ordered = replace(copy, order=np.tile(order, (len(copy.faces), 1)))
        found = placement_of(body, ordered, order in TURNED, config)
        if found is not None:
            return ordered, found
    return None


def _held(
    triangles: Triangles, kept: BoolArray, families: list[_Family], fewest_left: int
) -> Copies:
    """Without the copies; patches are numbered group after group, and none is of two bodies."""
    owners, covered = np.where(kept, 0, -1), kept.copy()
    for number, family in enumerate(families, 1):
        held = family.held(kept)
        for copy, _ in family.copies:
            owners[copy.faces] = -1
            covered[copy.faces] = held
        owners[family.body.faces[held]] = number
    chosen = owners >= 0
    patches = np.full(len(triangles), -1, np.int64)
    rows = np.stack([owners, triangles.bodies, triangles.patches], axis=1)
    patches[chosen] = row_ids(rows[chosen])
    groups = [Group(_span(patches[owners == 0]))] if (owners == 0).any() else []
    for family in families:
        own = patches[family.body.faces]
        groups.append(family.group(own, _span(own[own >= 0])))
    found = replace(triangles, patches=patches.astype(np.int32)).only(chosen)
    return Copies.weighed(found, groups, covered, fewest_left)


def _span(numbers: Int64Array) -> range:
    return range(int(numbers.min()), int(numbers.max()) + 1)
