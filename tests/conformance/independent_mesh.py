"""Mesh parts as section 8 of `format_spec.md` has them placed and asked."""

from __future__ import annotations

from functools import cached_property
from typing import Any

from tests.conformance import independent_meta

CAPS = independent_meta.CAPS


class Triangles:
    """All copies of all mesh parts; `decoder` has the names of the specification's blocks.

    A file is refused for its numbers alone: triangles are placed when they are first asked for.
    """

    def __init__(
        self, decoder: dict[str, Any], parts: list[dict[str, Any]], materials: int
    ) -> None:
        self.decoder = decoder
        self.copies: list[tuple[dict[str, Any], dict[str, Any]]] = []
        self.first_charts: list[int] = []
        self.chart_materials: list[int] = []
        self.chart_has_uv: list[bool] = []
        for part in parts:
            for placement in part["placements"]:
                self.add(part, placement)
        assert all(number < materials for number in self.chart_materials)

    def add(self, part: dict[str, Any], placement: dict[str, Any]) -> None:
        """One copy, its charts numbered on from those before."""
        self.copies.append((part, placement))
        self.first_charts.append(len(self.chart_materials))
        own = placement["materials"]
        self.chart_materials += part["chart_materials"] if own is None else own
        self.chart_has_uv += part["chart_has_uv"]
        assert len(self.chart_materials) <= CAPS["MAX_CHARTS"]

    @cached_property
    def corners(self) -> list[Any]:
        """The places of each triangle's corners."""
        found: list[Any] = []
        for part, placement in self.copies:
            places = [self.placed(part, placement, point) for point in part["positions"]]
            found += [[places[three[i]] for i in order(placement)] for three in part["faces"]]
        return found

    @cached_property
    def uvs(self) -> list[Any]:
        """The UVs of each triangle's corners; zeros on charts without."""
        found: list[Any] = []
        for part, placement in self.copies:
            uvs = [dressed(part, placement, uv) for uv in part["uvs"]]
            for three, chart in zip(part["uv_faces"], part["face_charts"], strict=True):
                has_uv = part["chart_has_uv"][chart]
                found.append([uvs[three[i]] if has_uv else [0.0, 0.0] for i in order(placement)])
        return found

    @cached_property
    def charts(self) -> list[int]:
        """The chart of each triangle."""
        copies = zip(self.copies, self.first_charts, strict=True)
        return [first + chart for (part, _), first in copies for chart in part["face_charts"]]

    @cached_property
    def sheet(self) -> list[bool]:
        """Whether each triangle is of a sheet."""
        return [flag for part, _ in self.copies for flag in part["sheet"]]

    def placed(self, part: dict[str, Any], placement: dict[str, Any], point: Any) -> list[float]:
        """Where a copy has a position of its part."""
        normalized = [
            t * part["step"] + start for t, start in zip(point, part["origin"], strict=True)
        ]
        found: list[float] = self.decoder["placed"](placement, normalized)
        return found

    def ask(self, point: list[float], chart: int | None = None) -> tuple[float, int, list[float]]:
        """Signed distance, triangle, weights of its corners; of a chart's triangles alone."""
        own = [i for i, other in enumerate(self.charts) if chart in (None, other)]
        triangles = [self.corners[i] for i in own]
        sheet = [self.sheet[i] for i in own]
        distance, number, weights = self.decoder["ask_triangles"](triangles, sheet, point)
        return distance, own[number], weights

    def uv(self, point: list[float], chart: int) -> list[float]:
        """The UV of the closest point on a chart."""
        if not self.chart_has_uv[chart]:
            return [0.0, 0.0]
        _, number, weights = self.ask(point, chart)
        return self.uv_of(number, weights)

    def uv_of(self, number: int, weights: list[float]) -> list[float]:
        """The UV in a triangle."""
        corners = self.uvs[number]
        return [
            sum(share * corner[axis] for share, corner in zip(weights, corners, strict=True))
            for axis in (0, 1)
        ]


def order(placement: dict[str, Any]) -> tuple[int, int, int]:
    """The corners of a copy's triangles, so that these look outwards."""
    return (0, 2, 1) if placement["mirrored"] else (0, 1, 2)


def dressed(part: dict[str, Any], placement: dict[str, Any], uv: Any) -> list[float]:
    """A copy's UV."""
    found = []
    for axis in (0, 1):
        own = uv[axis] * part["uv_step"][axis] + part["uv_origin"][axis]
        found.append(own * placement["uv_scale"][axis] + placement["uv_offset"][axis])
    return found
