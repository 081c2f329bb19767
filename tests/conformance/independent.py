"""A reader made of `format_spec.md` alone: its Python blocks, its tables, and MessagePack.

Nothing of nispcodec is imported: what the specification leaves open shows here.
"""

from __future__ import annotations

from io import BytesIO
from typing import Any

import msgpack
import numpy as np
import zstandard
from PIL import Image

from tests.format import spec

DECODER = spec.decoder()
ENUMERATIONS = ("ENCODINGS", "CONDITIONINGS", "ACTIVATIONS", "OUTPUTS", "WRAPS", "FILTERS")
NUMBERED = {name: spec.enumeration(name) for name in ENUMERATIONS}
WHITE = [1.0, 1.0, 1.0, 1.0]


class Reader:
    """One file, ready to answer at points of the normalized frame."""

    def __init__(self, file: bytes) -> None:
        rows = {row[0]: row for row in DECODER["read_table"](file)}
        meta = msgpack.unpackb(unpacked(rows["META"]), strict_map_key=False)
        self.k = meta.get(3, 1)
        self.frame = meta[1]
        self.materials = meta.get(7, [{}])
        self.chart_materials = numbers(meta.get(4), self.k, len(self.materials))
        self.has_uv = flags(meta.get(5), self.k)
        self.uv_map = meta.get(6, [0.0, 0.0, 1.0, 1.0])
        self.openings = int(meta.get(11, False))
        self.specs = {number: topology(fields) for number, fields in sorted(meta[2].items())}
        tensors = [(self.shapes(number), made["init_seed"]) for number, made in self.specs.items()]
        weights = DECODER["read_nets"](unpacked(rows["NETS"]), tensors)
        self.weights = dict(zip(self.specs, weights, strict=True))
        self.images = images(meta.get(8, []), unpacked(rows["TXTR"]) if "TXTR" in rows else b"")

    def shapes(self, number: int) -> list[tuple[int, int]]:
        """Rows and columns of a network's tensors (section 5)."""
        made = self.specs[number]
        coordinates = 3 + (made["mirror"] >> 3).bit_count() + (made["conditioning"] == "scalar")
        inputs = coordinates * (2 * made["levels"] if made["encoding"] == "fourier" else 1)
        widths = [inputs + made["embedding"], *made["hidden"], (1, self.k, 2)[number - 1]]
        outputs = widths[-1]
        table = {
            "chart_affine": [made["embedding"], outputs * coordinates, outputs],
        }.get(made["conditioning"], [])
        layers = zip(widths[1:], widths[:-1], strict=True)
        return [(self.k, columns) for columns in table] + [
            shape for rows, columns in layers for shape in ((rows, columns), (1, rows))
        ]

    def ask(self, number: int, point: list[float], chart: int = 0) -> list[float]:
        """Outputs of a network."""
        made, weights = self.specs[number], self.weights[number]
        answer: list[float] = DECODER["evaluate"](made, self.k, weights, point, chart)
        return answer

    def chart(self, point: list[float], closed: int = 0) -> int:
        """The largest logit but for the last `closed`, of equal ones the first; 0 with a NaN."""
        logits = self.ask(2, point) if 2 in self.specs else [0.0]
        largest: int = DECODER["largest"](logits[: self.k - closed])
        return largest

    def uv(self, point: list[float], chart: int) -> list[float]:
        """The place in the asset's UV."""
        if not self.has_uv[chart]:
            return [0.0, 0.0]
        u, v = self.ask(3, point, chart)
        left, low, wide, high = self.uv_map
        return [u * wide + left, v * high + low]

    def color(self, point: list[float]) -> list[float]:
        """RGBA: that of the likeliest chart that is no opening."""
        chart = self.chart(point, self.openings)
        return self.color_at(self.uv(point, chart), chart)

    def color_at(self, uv: list[float], chart: int) -> list[float]:
        """RGBA at a UV of a chart."""
        material = self.materials[self.chart_materials[chart]]
        used = material.get(9, {}).get(1)
        texels = None
        if used is not None and self.has_uv[chart]:
            wraps = [NUMBERED["WRAPS"][used.get(key, 1) - 1] for key in (2, 3)]
            image, sharp = self.images[used.get(1, 0)], NUMBERED["FILTERS"][used.get(4, 1) - 1]
            texels = DECODER["look_up"](image, *uv, *wraps, sharp)
        found: list[float] = DECODER["color"](material.get(2, WHITE), texels)
        return found


def unpacked(row: tuple[str, bool, bool, bytes, int]) -> bytes:
    """The content of a section."""
    _, _, packed, payload, length = row
    if packed:
        assert zstandard.get_frame_parameters(payload).content_size == length
        payload = zstandard.ZstdDecompressor().decompress(payload, allow_extra_data=False)
    assert len(payload) == length
    return payload


def topology(fields: dict[int, Any]) -> dict[str, Any]:
    """A network's fields by name, defaults filled in."""
    return {
        "hidden": fields[1],
        "encoding": NUMBERED["ENCODINGS"][fields.get(2, 1) - 1],
        "levels": fields.get(3, 0),
        "conditioning": NUMBERED["CONDITIONINGS"][fields.get(4, 1) - 1],
        "embedding": fields.get(5, 0),
        "activation": NUMBERED["ACTIVATIONS"][fields.get(6, 1) - 1],
        "w0": fields.get(7, 30.0),
        "output": NUMBERED["OUTPUTS"][fields.get(8, 1) - 1],
        "mirror": fields.get(9, 0),
        "init_seed": fields.get(10, 0),
    }


def numbers(data: bytes | None, count: int, materials: int) -> list[int]:
    """The material of each chart."""
    if data is None:
        return [0] * count
    return np.frombuffer(data, "u1" if materials <= 256 else "<u2", count).tolist()


def flags(data: bytes | None, count: int) -> list[bool]:
    """Which charts have texture coordinates."""
    if data is None:
        return [True] * count
    return [bool(data[place // 8] & 0x80 >> place % 8) for place in range(count)]


def images(described: list[dict[int, Any]], data: bytes) -> list[Any]:
    """RGBA in [0, 1] of every texture, row by row."""
    found, at = [], 0
    for each in described:
        length = each.get(3, len(data) - at)
        image = Image.open(BytesIO(data[at : at + length])).convert("RGBA")
        found.append((np.asarray(image, np.float64) / 255).tolist())
        at += length
    assert at == len(data)
    return found
