"""The content of a `.nisp` file, validated: what the encoder makes and the decoder reads."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, FloatArray, Int32Array
from nispcodec.core.asset import Material, Texture
from nispcodec.core.errors import FormatError
from nispcodec.core.network import MAX_CHARTS, Network


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
class Document:
    """The content of one file.

    `sdf` is always there; `chart` only when there are two charts or more; `uv` only when some chart
    has UV. `half_thickness` (normalized frame) is given to open surfaces, 0 when there are none;
    with it the surface has parts as thin as twice this.
    `info` holds what was measured and how the file was made: plain str, int, float and bool values.
    `extra` holds the ancillary sections that this version does not know, by four-character code:
    they are kept when the document is written again.
    Raises FormatError when the parts do not fit together, such as a chart of an unknown material.
    """

    frame: Frame
    charts: ChartTable
    materials: tuple[Material, ...]
    textures: tuple[Texture, ...]
    sdf: Network
    chart: Network | None = None
    uv: Network | None = None
    half_thickness: float = 0.0
    info: Mapping[str, str | int | float | bool] = field(default_factory=dict)
    extra: Mapping[str, StoredSection] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._check_tables()
        self._check_maps()
        self._check_networks()

    def _check_tables(self) -> None:
        k = len(self.charts)
        _demand("document.charts", 1 <= k <= MAX_CHARTS, f"1 to {MAX_CHARTS}", k)
        _demand("document.frame", self.frame.radius > 0, "a positive radius", self.frame.radius)
        _demand("document.materials", len(self.materials) > 0, "at least one", 0)
        materials = self.charts.materials
        _demand(
            "document.chart_materials",
            materials.min() >= 0 and materials.max() < len(self.materials),
            f"0 to {len(self.materials) - 1}",
            f"{materials.min()} to {materials.max()}",
        )
        if self.charts.openings:
            _demand("document.openings", k > 1, "two charts or more", k)
            _demand(
                "document.openings", not self.charts.has_uv[-1], "a last chart without UV", "UV"
            )

    def _check_maps(self) -> None:
        for number, material in enumerate(self.materials):
            for slot, used in material.maps.items():
                _demand(
                    f"materials.{number}.maps.{slot}.texture",
                    0 <= used.texture < len(self.textures),
                    f"a texture below {len(self.textures)}",
                    used.texture,
                )

    def _check_networks(self) -> None:
        k = len(self.charts)
        _demand("networks.sdf", self.sdf.spec.outputs == 1, 1, self.sdf.spec.outputs)
        _demand(
            "networks.chart",
            (self.chart is not None) == (k > 1),
            "one for two charts or more",
            f"{k} charts",
        )
        _demand(
            "networks.uv",
            (self.uv is not None) == bool(self.charts.has_uv.any()),
            "one when a chart has UV",
            f"{int(self.charts.has_uv.sum())} charts with UV",
        )
        if self.chart is not None:
            _demand("networks.chart", self.chart.spec.outputs == k, k, self.chart.spec.outputs)
        if self.uv is not None:
            _demand("networks.uv", self.uv.spec.outputs == 2, 2, self.uv.spec.outputs)
            conditioned = self.uv.spec.conditioning != "none"
            _demand(
                "networks.uv",
                self.uv.spec.charts == (k if conditioned else 0),
                k,
                self.uv.spec.charts,
            )

    @property
    def networks(self) -> dict[str, Network]:
        """The networks that are there, by name: sdf, chart, uv."""
        named = {"sdf": self.sdf, "chart": self.chart, "uv": self.uv}
        return {name: network for name, network in named.items() if network is not None}


def _demand(field_name: str, holds: bool, expected: object, found: object) -> None:
    if not holds:
        raise FormatError("document", field_name, expected, found)
