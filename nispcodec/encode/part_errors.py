"""How far the surface of each part of a document is off the original's."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import Document
from nispcodec.core.errors import MeshError
from nispcodec.simplify.errors import Original


def part_errors(
    document: Document, mesh: TexturedMesh, original: Original, samples: int
) -> Iterator[tuple[float, float]]:
    """Mean distance and mean UV error of the field, if there is one, then of every mesh part.

    mesh is what the document decodes to, positions in the normalized frame. Both are from about
    `samples` points, shared by all parts, of a part to the original, as what is lost is no part's;
    NaN for a part whose surface has no area.
    """
    counts = [len(each.faces) * len(each.placements) for each in document.meshes]
    first = [len(mesh.faces) - sum(counts)] if document.field else []
    ends = np.cumsum([0, *first, *counts])
    each = max(1, samples // (len(ends) - 1))
    number = np.arange(len(mesh.faces))
    for start, end in pairwise(ends.tolist()):
        try:
            yield original.errors_from(mesh.only((start <= number) & (number < end)), each)
        except MeshError:
            yield np.nan, np.nan
