"""The content of a `.nisp` file, validated: what the encoder makes and the decoder reads."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from dataclasses import field as default

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, FloatArray, Int32Array
from nispcodec.core.asset import Material, Texture
from nispcodec.core.errors import FormatError
from nispcodec.core.mesh_part import PART, MeshPart, Placement, check_placed_faces
from nispcodec.core.network import MAX_CHARTS, Network

DOCUMENT = "document"
"""The section in errors of this module, but for those of mesh parts."""


@dataclass(frozen=True)
class Frame:
    """From the normalized frame to the world: world = normalized * radius + center.

    `center` and `radius` are in world units.
    """

    center: tuple[float, float, float]
    radius: float

    def to_world(self, points: FloatArray) -> Float64Array:
        """Points (n, 3) of the normalized frame -> (n, 3) float64 in the world frame."""
        return np.asarray(points, dtype=np.float64) * self.radius + np.asarray(self.center)

    def to_normalized(self, points: FloatArray) -> Float64Array:
        """Points (n, 3) of the world frame -> (n, 3) float64 in the normalized frame."""
        return (np.asarray(points, dtype=np.float64) - np.asarray(self.center)) / self.radius


@dataclass(frozen=True)
class ChartTable:
    """The material of each of the k charts, and the affine map from network UV to the asset's UV.

    materials (k,) int32 into the document's materials; has_uv (k,) bool;
    asset UV = network UV * uv_scale + uv_offset, for each axis. A chart without UV answers (0, 0).
    With `openings` the last chart is no part of the asset: it is where the SDF closes openings.
    """

    materials: Int32Array
    has_uv: BoolArray
    uv_offset: tuple[float, float] = (0.0, 0.0)
    uv_scale: tuple[float, float] = (1.0, 1.0)
    openings: bool = False

    def __len__(self) -> int:
        return len(self.materials)


@dataclass(frozen=True)
class StoredSection:
    """An ancillary section as its payload stands in a file: it is unknown, and not looked into.

    decoded_length  bytes of the content of a packed payload, None where the payload is the content
    """

    payload: bytes
    decoded_length: int | None = None


@dataclass(frozen=True)
class Field:
    """The part of an asset that networks hold: its SDF, its charts, its UVs.

    `chart` is there only when there are two charts or more, `uv` only when some chart has UV.
    `half_thickness` (normalized frame) is given to open surfaces, 0 when there are none; with it
    the surface has parts as thin as twice this. Raises FormatError for networks that do not fit
    the chart table.
    """

    charts: ChartTable
    sdf: Network
    chart: Network | None = None
    uv: Network | None = None
    half_thickness: float = 0.0

    def __post_init__(self) -> None:
        k = len(self.charts)
        _demand("document.charts", 1 <= k <= MAX_CHARTS, f"1 to {MAX_CHARTS}", k)
        if self.charts.openings:
            _demand("document.openings", k > 1, "two charts or more", k)
            _demand(
                "document.openings", not self.charts.has_uv[-1], "a last chart without UV", "UV"
            )
        _demand("networks.sdf", self.sdf.spec.outputs == 1, 1, self.sdf.spec.outputs)
        self._check_chart(k)
        self._check_uv(k)

    def _check_chart(self, k: int) -> None:
        found = f"{k} charts"
        _demand(
            "networks.chart",
            (self.chart is not None) == (k > 1),
            "one for two charts or more",
            found,
        )
        if self.chart is not None:
            _demand("networks.chart", self.chart.spec.outputs == k, k, self.chart.spec.outputs)

    def _check_uv(self, k: int) -> None:
        dressed = int(self.charts.has_uv.sum())
        found = f"{dressed} charts with UV"
        _demand(
            "networks.uv", (self.uv is not None) == (dressed > 0), "one when a chart has UV", found
        )
        if self.uv is not None:
            _demand("networks.uv", self.uv.spec.outputs == 2, 2, self.uv.spec.outputs)
            conditioned = self.uv.spec.conditioning != "none"
            expected = k if conditioned else 0
            _demand("networks.uv", self.uv.spec.charts == expected, k, self.uv.spec.charts)

    @property
    def networks(self) -> dict[str, Network]:
        """The networks that are there, by name: sdf, chart, uv."""
        named = {"sdf": self.sdf, "chart": self.chart, "uv": self.uv}
        return {name: network for name, network in named.items() if network is not None}


@dataclass(frozen=True)
class Document:
    """The content of one file: a field, meshes, or both.

    Charts are numbered through: those of the field, then those of every placement of every mesh.
    `info` holds what was measured and how the file was made: plain str, int, float and bool values.
    `extra` holds the ancillary sections that this version does not know, by four-character code:
    they are kept when the document is written again.
    Raises FormatError when the parts do not fit together, such as a chart of an unknown material,
    and for more faces or charts with all copies of meshes than a file may have.
    """

    frame: Frame
    materials: tuple[Material, ...]
    textures: tuple[Texture, ...]
    field: Field | None = None
    meshes: tuple[MeshPart, ...] = ()
    info: Mapping[str, str | int | float | bool] = default(default_factory=dict)
    extra: Mapping[str, StoredSection] = default(default_factory=dict)

    def __post_init__(self) -> None:
        _demand("document.frame", self.frame.radius > 0, "a positive radius", self.frame.radius)
        _demand(
            "document.parts",
            bool(self.meshes) or self.field is not None,
            "a field or a mesh",
            "none",
        )
        _demand("document.materials", len(self.materials) > 0, "at least one", 0)
        if self.field:
            self._check_materials(DOCUMENT, "document.chart_materials", self.field.charts.materials)
        self._check_meshes()
        self._check_maps()

    def _check_meshes(self) -> None:
        """Counts come first: what copies have is made for each of them."""
        check_placed_faces(sum(part.placed_faces for part in self.meshes))
        charts = len(self.field.charts) if self.field else 0
        charts += sum(part.placed_charts for part in self.meshes)
        if charts > MAX_CHARTS:
            raise FormatError(PART, "charts", f"at most {MAX_CHARTS} with all copies", charts)
        for part, placement in self._placed():
            self._check_materials(PART, "materials", _materials(part, placement))

    def _check_materials(self, section: str, field_name: str, numbers: Int32Array) -> None:
        low, high = int(numbers.min(initial=0)), int(numbers.max(initial=0))
        if low < 0 or high >= len(self.materials):
            expected = f"0 to {len(self.materials) - 1}"
            raise FormatError(section, field_name, expected, f"{low} to {high}")

    def _check_maps(self) -> None:
        for number, material in enumerate(self.materials):
            for slot, used in material.maps.items():
                _demand(
                    f"materials.{number}.maps.{slot}.texture",
                    0 <= used.texture < len(self.textures),
                    f"a texture below {len(self.textures)}",
                    used.texture,
                )

    @property
    def networks(self) -> dict[str, Network]:
        """The field's networks by name: sdf, chart, uv; none without a field."""
        return self.field.networks if self.field else {}

    @property
    def chart_materials(self) -> Int32Array:
        """(k,) int32: the material of each chart."""
        own = [self.field.charts.materials] if self.field else []
        return np.concatenate([*own, *(_materials(each, to) for each, to in self._placed())])

    @property
    def chart_has_uv(self) -> BoolArray:
        """(k,) bool: which charts have texture coordinates."""
        own = [self.field.charts.has_uv] if self.field else []
        return np.concatenate([*own, *(each.chart_has_uv for each, _ in self._placed())])

    def _placed(self) -> Iterator[tuple[MeshPart, Placement]]:
        return ((each, placement) for each in self.meshes for placement in each.placements)


def _materials(part: MeshPart, placement: Placement) -> Int32Array:
    return part.chart_materials if placement.materials is None else placement.materials


def _demand(field_name: str, holds: bool, expected: object, found: object) -> None:
    if not holds:
        raise FormatError(DOCUMENT, field_name, expected, found)
