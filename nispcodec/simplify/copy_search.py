"""Which bodies are copies of others: turned, scaled, reflected, with other UVs and materials.

Copies in a file have their faces in the same order: corner for corner, a similarity is fitted, and
checked at every corner. The corners of a face may begin with another, and go the other way around
where the copy is a reflection.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from nispcodec.core.arrays import Int32Array, Int64Array
from nispcodec.core.connectivity import row_ids
from nispcodec.core.mesh_part import Placement
from nispcodec.simplify.body import Body, placement_of
from nispcodec.simplify.config import CopiesConfig
from nispcodec.simplify.copies import Copies, Group
from nispcodec.simplify.triangles import Triangles

KEPT = ((0, 1, 2), (1, 2, 0), (2, 0, 1))
TURNED = ((0, 2, 1), (2, 1, 0), (1, 0, 2))


def copies_of(triangles: Triangles, config: CopiesConfig) -> Copies:
    """Bodies that are copies stand for each other; the largest is the one that is held."""
    families = [
        family
        for alike in _alike(triangles, config.fewest)
        for family in _families(alike, config)
        if len(family.copies) > 1
    ]
    return _held(triangles, families) if families else Copies.none(triangles)


@dataclass(frozen=True)
class _Family:
    """A body and all that are copies of it, corner for corner, itself among them."""

    body: Body
    copies: list[tuple[Body, Placement]]

    def group(self, patches: Int64Array, own: range) -> Group:
        """patches (k,): the number of the patch of each face; own: those numbers."""
        tables: list[Int32Array] = []
        for copy, _ in self.copies:
            table = np.zeros(len(own), np.int32)
            table[patches - own.start] = copy.triangles.materials[copy.faces]
            tables.append(table)
        return Group(
            patches=own,
            placements=tuple(placement for _, placement in self.copies),
            materials=tuple(None if (each == tables[0]).all() else each for each in tables),
        )


def _alike(triangles: Triangles, fewest: int) -> Iterator[list[Body]]:
    """Lists of bodies with as many faces, with UVs and of sheets; large bodies first."""
    bodies = triangles.bodies
    order, counts = np.argsort(bodies, kind="stable"), np.bincount(bodies)
    kinds = np.bincount(bodies, triangles.has_uv), np.bincount(bodies, triangles.sheet)
    numbers = row_ids(np.stack([counts, *kinds], axis=1))
    found: dict[int, list[Body]] = {}
    for number, faces in zip(numbers, np.split(order, np.cumsum(counts)[:-1]), strict=True):
        if len(faces) >= fewest:
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


def _held(triangles: Triangles, families: list[_Family]) -> Copies:
    """Without the copies; patches are numbered group after group, and none is of two bodies."""
    owners = np.zeros(len(triangles), np.int64)
    for number, family in enumerate(families, 1):
        for copy, _ in family.copies:
            owners[copy.faces] = -1
        owners[family.body.faces] = number
    kept = owners >= 0
    patches = np.full(len(triangles), -1, np.int64)
    rows = np.stack([owners, triangles.bodies, triangles.patches], axis=1)
    patches[kept] = row_ids(rows[kept])
    groups = [Group(_span(patches[owners == 0]))] if (owners == 0).any() else []
    for family in families:
        own = patches[family.body.faces]
        groups.append(family.group(own, _span(own)))
    held = replace(triangles, patches=patches.astype(np.int32)).only(kept)
    return Copies(held, tuple(groups))


def _span(numbers: Int64Array) -> range:
    return range(int(numbers.min()), int(numbers.max()) + 1)
