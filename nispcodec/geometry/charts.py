"""Charts: patches of faces connected through shared (material, position, uv) corners."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from nispcodec.core.arrays import BoolArray, Int32Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.geometry.welding import Welding

Kind = TypeVar("Kind")


@dataclass(frozen=True)
class Charts:
    """The k charts of a mesh of m faces.

    face_charts  (m,) int32, 0 to k - 1: the chart of each face
    materials    (k,) int32, into the mesh's materials
    has_uv       (k,) bool: which charts have UVs
    """

    face_charts: Int32Array
    materials: Int32Array
    has_uv: BoolArray

    def __len__(self) -> int:
        return len(self.materials)


def split_charts(mesh: TexturedMesh, welding: Welding) -> Charts:
    """Label every face with its chart; the faces of one material without UV make one chart.

    Charts are numbered by their first face.
    """
    labels = welding.patches
    first = np.unique(labels, return_index=True)[1]
    return Charts(labels, mesh.face_materials[first], mesh.has_uv[first])


def colored(
    neighbors: list[set[int]],
    kinds: list[Kind],
    palette: Sequence[Kind] = (),
    choose: Callable[[int, Sequence[int]], int] = lambda node, colors: colors[0],
) -> tuple[list[int], list[Kind]]:
    """Color a graph so that neighbors differ and every color is of one kind.

    `neighbors` holds the neighbors of each node, `kinds` its kind. Returns the color of each node
    and the kind of each color. The colors are those of `palette` to begin with, and one more
    whenever a node finds none; `choose(node, colors)` takes one of several. Nodes with the most
    neighbors come first (Welsh and Powell 1967).
    """
    color = [-1] * len(neighbors)
    kind_of_color = list(palette)
    for node in sorted(range(len(neighbors)), key=lambda n: -len(neighbors[n])):
        taken = {color[other] for other in neighbors[node]}
        alike = [c for c, k in enumerate(kind_of_color) if k == kinds[node] and c not in taken]
        if not alike:
            alike = [len(kind_of_color)]
            kind_of_color.append(kinds[node])
        color[node] = choose(node, alike)
    return color, kind_of_color
