"""All parts of an asset as one: the union of their distances, the looks of the nearest."""

from __future__ import annotations

from collections.abc import Callable
from itertools import accumulate
from typing import Protocol

import numpy as np

from nispcodec.core.arrays import AnyArray, Float32Array, Int32Array, IntArray
from nispcodec.core.document import Document
from nispcodec.infer.field import FieldQueries
from nispcodec.infer.mesh_queries import PlacedMeshes


class Queries(Protocol):
    """One part, or several of one kind, asked at points (n, 3) float32 in the normalized frame."""

    @property
    def chart_count(self) -> int:
        """How many charts it numbers, from 0 on."""

    def sdf(self, points: Float32Array) -> Float32Array:
        """Signed distance to the surface (n,)."""

    def normals(self, points: Float32Array) -> Float32Array:
        """Unit gradient of the distance (n, 3), 0 where there is none."""

    def charts(self, points: Float32Array, seen: bool = False) -> Int32Array:
        """The chart of each point (n,); with `seen` one that is no opening."""

    def uv(self, points: Float32Array, charts: IntArray) -> Float32Array:
        """The asset's UV (n, 2) on charts (n,); (0, 0) on those without UV."""

    def project(self, points: Float32Array) -> Float32Array:
        """The points moved onto the surface (n, 3)."""


class Union:
    """A document's field and meshes, asked as one part: charts are numbered through."""

    def __init__(self, document: Document) -> None:
        self._parts: list[Queries] = []
        if document.field:
            self._parts.append(FieldQueries(document.field))
        if document.meshes:
            self._parts.append(PlacedMeshes(document.meshes))
        counts = [part.chart_count for part in self._parts]
        self._first_charts = list(accumulate(counts, initial=0))

    @property
    def chart_count(self) -> int:
        """How many charts there are."""
        return self._first_charts[-1]

    def sdf(self, points: Float32Array) -> Float32Array:
        """The least of all parts' signed distances (n,)."""
        return np.minimum.reduce([part.sdf(points) for part in self._parts])

    def normals(self, points: Float32Array) -> Float32Array:
        """The normals (n, 3) of the part whose signed distance is the least."""
        return self._asked(lambda part, at, _: part.normals(at), points, self._deepest(points))

    def charts(self, points: Float32Array, seen: bool = False) -> Int32Array:
        """The chart (n,) of the part whose surface is nearest."""

        def ask(part: Queries, at: Float32Array, first: int) -> AnyArray:
            return first + part.charts(at, seen)

        return self._asked(ask, points, self._nearest(points))

    def uv(self, points: Float32Array, charts: IntArray) -> Float32Array:
        """The asset's UV (n, 2) on charts (n,), each by the part that has the chart."""
        uvs = np.zeros((len(points), 2), np.float32)
        for part, first in zip(self._parts, self._first_charts, strict=False):
            own = np.flatnonzero((charts >= first) & (charts < first + part.chart_count))
            if len(own):
                uvs[own] = part.uv(points[own], charts[own] - first)
        return uvs

    def project(self, points: Float32Array) -> Float32Array:
        """The points moved onto the surface of the part that is nearest (n, 3)."""
        return self._asked(lambda part, at, _: part.project(at), points, self._nearest(points))

    def _deepest(self, points: Float32Array) -> IntArray | None:
        return self._chosen([part.sdf for part in self._parts], points)

    def _nearest(self, points: Float32Array) -> IntArray | None:
        def unsigned(part: Queries) -> Callable[[Float32Array], Float32Array]:
            return lambda at: np.abs(part.sdf(at))

        return self._chosen([unsigned(part) for part in self._parts], points)

    def _chosen(
        self, distances: list[Callable[[Float32Array], Float32Array]], points: Float32Array
    ) -> IntArray | None:
        """Which part has the least distance; None where there is one part only."""
        if len(distances) == 1:
            return None
        return np.argmin([distance(points) for distance in distances], axis=0)

    def _asked(
        self,
        ask: Callable[[Queries, Float32Array, int], AnyArray],
        points: Float32Array,
        chosen: IntArray | None,
    ) -> AnyArray:
        """Answers of the chosen parts (n, ...)."""
        if chosen is None:
            return ask(self._parts[0], points, 0)
        answers: AnyArray | None = None
        for number, part in enumerate(self._parts):
            own = np.flatnonzero(chosen == number)
            found = ask(part, points[own], self._first_charts[number])
            if answers is None:
                answers = np.empty((len(points), *found.shape[1:]), found.dtype)
            answers[own] = found
        assert answers is not None
        return answers
