"""A reader made of `format_spec.md` alone: its Python blocks, its tables, its words.

Nothing of nispcodec is imported: what the specification leaves open shows here. A file that must be
refused raises an exception of any kind.
"""

from __future__ import annotations

import math
from io import BytesIO
from typing import Any

import numpy as np
import zstandard
from PIL import Image

from tests.conformance import independent_mesh, independent_meta
from tests.format import spec

DECODER = spec.decoder()
CAPS = independent_meta.CAPS
NETWORKS = ("sdf", "chart", "uv")
KNOWN = ("MESH", "META", "NETS", "TXTR")
FORMATS = ("PNG", "JPEG", "WEBP", "AVIF")
STEP = 1e-6
"""Differences over so much stand for derivatives; all is float64."""


class Reader:
    """One file, ready to answer at points of the normalized frame."""

    def __init__(self, file: bytes) -> None:
        rows = {row[0]: row for row in DECODER["read_table"](file)}
        check_sections(rows)
        self.meta = independent_meta.read_document(unpacked(rows["META"]))
        assert ("TXTR" in rows) == bool(self.meta["textures"])
        self.specs: dict[str, Any] = self.meta["networks"]
        assert ("NETS" in rows) == bool(self.specs)
        assert "MESH" in rows or self.specs
        self.k = self.meta["charts"] if self.specs else 0
        tensors = [(self.shapes(name), made["init_seed"]) for name, made in self.specs.items()]
        assert sum(r * c for shapes, _ in tensors for r, c in shapes) <= CAPS["MAX_WEIGHTS"]
        weights = DECODER["read_nets"](unpacked(rows["NETS"]), tensors) if self.specs else []
        self.weights = dict(zip(self.specs, weights, strict=True))
        self.parts = DECODER["read_mesh"](unpacked(rows["MESH"])) if "MESH" in rows else []
        self.mesh = independent_mesh.Triangles(DECODER, self.parts, len(self.meta["materials"]))
        self.chart_materials = self.meta["chart_materials"] + self.mesh.chart_materials
        self.chart_has_uv = self.meta["chart_has_uv"] + self.mesh.chart_has_uv
        assert len(self.chart_materials) <= CAPS["MAX_CHARTS"]
        self.files = images(
            self.meta["textures"], unpacked(rows["TXTR"]) if "TXTR" in rows else b""
        )
        self.decoded: dict[int, Any] = {}

    def shapes(self, name: str) -> list[tuple[int, int]]:
        """Rows and columns of a network's tensors (section 5)."""
        made = self.specs[name]
        coordinates = 3 + (made["mirror"] >> 3).bit_count()
        entering = coordinates + (made["conditioning"] == "scalar")
        inputs = entering * (2 * made["levels"] if made["encoding"] == "fourier" else 1)
        outputs = {"sdf": 1, "chart": self.k, "uv": 2}[name]
        widths = [inputs + made["embedding"], *made["hidden"], outputs]
        table = [made["embedding"], outputs * coordinates, outputs]
        affine = made["conditioning"] == "chart_affine"
        layers = zip(widths[1:], widths[:-1], strict=True)
        return [(self.k, columns) for columns in table if affine] + [
            shape for rows, columns in layers for shape in ((rows, columns), (1, rows))
        ]

    def ask(self, name: str, point: list[float], chart: int = 0) -> list[float]:
        """Outputs of a network."""
        made, weights = self.specs[name], self.weights[name]
        answer: list[float] = DECODER["evaluate"](made, self.k, weights, point, chart)
        return answer

    def distances(self, point: list[float]) -> list[float]:
        """Signed, of the field and of the mesh parts; infinite where there are none."""
        field = self.ask("sdf", point)[0] if self.specs else math.inf
        return [field, self.mesh.ask(point)[0] if self.parts else math.inf]

    def distance(self, point: list[float]) -> float:
        """The signed distance, normalized frame."""
        field, mesh = self.distances(point)
        return min(field, mesh) if self.parts else field

    def normal(self, point: list[float]) -> list[float]:
        """The gradient of the distance, divided by its length; 0 where it is 0."""
        slopes = []
        for axis in range(3):
            ends = [[t + way * (i == axis) for i, t in enumerate(point)] for way in (STEP, -STEP)]
            ahead, behind = (self.distance(end) for end in ends)
            slopes.append((ahead - behind) / (2 * STEP))
        length = math.hypot(*slopes)
        return [slope / (length or 1.0) for slope in slopes]

    def chart(self, point: list[float], closed: int = 0) -> int:
        """That of the part which is nearest, of the field's but for the last `closed`."""
        field, mesh = self.distances(point)
        if self.parts and abs(mesh) < abs(field):
            return self.k + self.mesh.charts[self.mesh.ask(point)[1]]
        return self.field_chart(point, closed)

    def field_chart(self, point: list[float], closed: int) -> int:
        """The largest logit but for the last `closed`, of equal ones the first; 0 with a NaN."""
        logits = self.ask("chart", point) if "chart" in self.specs else [0.0]
        largest: int = DECODER["largest"](logits[: self.k - closed])
        return largest

    def uv(self, point: list[float], chart: int) -> list[float]:
        """The place in the asset's UV."""
        if not self.chart_has_uv[chart]:
            return [0.0, 0.0]
        if chart >= self.k:
            return self.mesh.uv(point, chart - self.k)
        u, v = self.ask("uv", point, chart)
        left, low, wide, high = self.meta["uv_map"]
        return [u * wide + left, v * high + low]

    def color(self, point: list[float]) -> list[float]:
        """RGBA: that of the likeliest chart that is no opening."""
        chart = self.chart(point, int(self.meta["openings"]))
        return self.color_at(self.uv(point, chart), chart)

    def color_at(self, uv: list[float], chart: int) -> list[float]:
        """RGBA at a UV of a chart."""
        material = self.meta["materials"][self.chart_materials[chart]]
        used = material["maps"].get("base_color")
        texels = None
        if used is not None and self.chart_has_uv[chart]:
            wraps = used["wrap_u"], used["wrap_v"]
            texels = DECODER["look_up"](self.image(used["texture"]), *uv, *wraps, used["filter"])
        found: list[float] = DECODER["color"](material["base_color"], texels)
        return found

    def image(self, number: int) -> Any:
        """RGBA in [0, 1] of a texture, row by row."""
        if number not in self.decoded:
            self.decoded[number] = pixels(self.files[number])
        return self.decoded[number]


def check_sections(rows: dict[str, Any]) -> None:
    """Which sections there must be and may be."""
    assert "META" in rows
    for code, critical, *_ in rows.values():
        assert critical == (code in KNOWN)
    packed = sum(row[4] for row in rows.values() if row[2])
    assert packed <= CAPS["MAX_UNPACKED"]


def unpacked(row: tuple[str, bool, bool, bytes, int]) -> bytes:
    """The content of a section."""
    _, _, packed, payload, length = row
    if packed:
        assert zstandard.get_frame_parameters(payload).content_size == length
        assert payload[4] & 7 == 0
        unpack = zstandard.ZstdDecompressor().decompress
        payload = unpack(payload, max_output_size=length, allow_extra_data=False)
    assert len(payload) == length
    return payload


def images(described: list[dict[str, Any]], data: bytes) -> list[bytes]:
    """The file of every texture."""
    found, at = [], 0
    for each in described:
        length = len(data) - at if each["length"] is None else each["length"]
        assert 0 < length <= len(data) - at
        found.append(data[at : at + length])
        at += length
    return found


def pixels(file: bytes) -> Any:
    """RGBA in [0, 1] of an image as stored, row by row."""
    image = Image.open(BytesIO(file), formats=FORMATS)
    if image.mode.startswith("I"):
        gray = np.asarray(image, np.float64)[..., None] / 65535
        return np.concatenate([gray, gray, gray, np.ones_like(gray)], axis=2).tolist()
    return (np.asarray(image.convert("RGBA"), np.float64) / 255).tolist()
