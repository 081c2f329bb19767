"""Mesh parts as section 8 of `format_spec.md` has them placed and asked."""

from __future__ import annotations

from typing import Any

from tests.conformance import independent_meta

CAPS = independent_meta.CAPS


class Triangles:
    """All copies of all mesh parts; `decoder` has the names of the specification's blocks."""

    def __init__(
        self, decoder: dict[str, Any], parts: list[dict[str, Any]], materials: int
    ) -> None:
        self.decoder = decoder
        self.corners: list[Any] = []
        self.uvs: list[Any] = []
        self.charts: list[int] = []
        self.sheet: list[bool] = []
        self.chart_materials: list[int] = []
        self.chart_has_uv: list[bool] = []
        for part in parts:
            for placement in part["placements"]:
                self.add(part, placement)
        assert all(number < materials for number in self.chart_materials)

    def add(self, part: dict[str, Any], placement: dict[str, Any]) -> None:
        """One copy, its charts numbered on from those before."""
        first = len(self.chart_materials)
        own = placement["materials"]
        self.chart_materials += part["chart_materials"] if own is None else own
        self.chart_has_uv += part["chart_has_uv"]
        assert len(self.chart_materials) <= CAPS["MAX_CHARTS"]
        places = [self.placed(part, placement, point) for point in part["positions"]]
        uvs = [dressed(part, placement, uv) for uv in part["uvs"]]
        order = (0, 2, 1) if placement["mirrored"] else (0, 1, 2)
        for number, chart in enumerate(part["face_charts"]):
            three, uv_three = part["faces"][number], part["uv_faces"][number]
            self.corners.append([places[three[i]] for i in order])
            has_uv = part["chart_has_uv"][chart]
            self.uvs.append([uvs[uv_three[i]] if has_uv else [0.0, 0.0] for i in order])
            self.charts.append(first + chart)
            self.sheet.append(part["sheet"][number])

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


def dressed(part: dict[str, Any], placement: dict[str, Any], uv: Any) -> list[float]:
    """A copy's UV."""
    found = []
    for axis in (0, 1):
        own = uv[axis] * part["uv_step"][axis] + part["uv_origin"][axis]
        found.append(own * placement["uv_scale"][axis] + placement["uv_offset"][axis])
    return found
