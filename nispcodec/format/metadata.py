"""The META section: everything of a document but the weights and the images."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from nispcodec.core.asset import Material
from nispcodec.core.document import ChartTable, Document, Field, Frame
from nispcodec.core.network import MAX_CHARTS, NetworkSpec
from nispcodec.format import canonical, measures, topology
from nispcodec.format.constants import META
from nispcodec.format.materials import (
    decode_material,
    decode_textures,
    encode_material,
    encode_textures,
)
from nispcodec.format.record import Record, sparse

_UV_MAP = (0.0, 0.0, 1.0, 1.0)


@dataclass(frozen=True)
class Metadata:
    """The content of META: a document without its weights, triangles and images.

    Without a field there are no `charts` and no `specs`. `textures` are (name, mime type, bytes in
    TXTR); None for the last, which takes what is left.
    """

    frame: Frame
    charts: ChartTable | None
    materials: tuple[Material, ...]
    textures: tuple[tuple[str, str, int | None], ...]
    specs: dict[str, NetworkSpec]
    half_thickness: float
    info: Mapping[str, measures.Scalar]


def encode(document: Document) -> bytes:
    """The bytes of META. Raises FormatError for a document that META cannot hold."""
    fields: dict[int, tuple[Any, Any]] = {
        1: ([float(x) for x in (*document.frame.center, document.frame.radius)], None),
        7: ([encode_material(material) for material in document.materials], [{}]),
        8: (encode_textures(document.textures), []),
        10: (measures.encode(document.info), {}),
    }
    if document.field:
        fields |= _field_items(document.field, len(document.materials))
    return canonical.encode(META, sparse(fields))


def _field_items(field: Field, materials: int) -> dict[int, tuple[Any, Any]]:
    table = field.charts
    specs = {name: network.spec for name, network in field.networks.items()}
    return {
        2: (topology.encode(specs), None),
        3: (len(table), 1),
        4: (_material_bytes(table, materials), b""),
        5: (b"" if table.has_uv.all() else np.packbits(table.has_uv).tobytes(), b""),
        6: ([float(x) for x in (*table.uv_offset, *table.uv_scale)], list(_UV_MAP)),
        9: (float(field.half_thickness), 0.0),
        11: (table.openings, False),
    }


def decode(data: bytes | memoryview) -> Metadata:
    """The content of META, each field checked; `Document` checks the relations between them.

    Raises FormatError for malformed bytes.
    """
    record = Record(META, "document", canonical.decode(META, data))
    x, y, z, radius = record.floats(1, "frame", 4)
    materials = tuple(
        decode_material(index, value)
        for index, value in enumerate(record.take(7, "materials", list, [{}]))
    )
    charts, specs, half_thickness = None, {}, 0.0
    if 2 in record:
        networks = Record(META, "networks", record.take(2, "networks", dict))
        count = record.integer(3, "charts", 1, MAX_CHARTS, 1)
        charts = _decode_charts(record, count, len(materials))
        specs = topology.decode(networks, count)
        half_thickness = record.take(9, "half_thickness", float, 0.0)
    metadata = Metadata(
        frame=Frame((x, y, z), radius),
        charts=charts,
        materials=materials,
        textures=decode_textures(record.take(8, "textures", list, [])),
        specs=specs,
        half_thickness=half_thickness,
        info=measures.decode(record.take(10, "info", dict, {})),
    )
    record.finish()
    return metadata


def _decode_charts(record: Record, count: int, materials: int) -> ChartTable:
    indices = record.take(4, "chart_materials", bytes, b"")
    flags = record.take(5, "chart_has_uv", bytes, b"")
    u, v, scale_u, scale_v = record.floats(6, "uv_map", 4, _UV_MAP)
    table = ChartTable(
        materials=_materials(record, indices, count, materials),
        has_uv=_flags(record, flags, count),
        uv_offset=(u, v),
        uv_scale=(scale_u, scale_v),
        openings=record.take(11, "openings", bool, False),
    )
    if indices and not table.materials.any():
        raise record.error("chart_materials", "absent, being all 0", "present")
    if flags and table.has_uv.all():
        raise record.error("chart_has_uv", "absent, being all set", "present")
    return table


def _index_type(materials: int) -> np.dtype[Any]:
    return np.dtype("u1") if materials <= 256 else np.dtype("<u2")


def _material_bytes(table: ChartTable, materials: int) -> bytes:
    return (
        table.materials.astype(_index_type(materials)).tobytes() if table.materials.any() else b""
    )


def _materials(
    record: Record, data: bytes, count: int, materials: int
) -> np.ndarray[tuple[int], np.dtype[np.int32]]:
    if not data:
        return np.zeros(count, np.int32)
    kind = _index_type(materials)
    if len(data) != count * kind.itemsize:
        raise record.error("chart_materials", f"{count * kind.itemsize} bytes", len(data))
    return np.frombuffer(data, kind).astype(np.int32)


def _flags(record: Record, data: bytes, count: int) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    if not data:
        return np.ones(count, np.bool_)
    if len(data) != (count + 7) // 8:
        raise record.error("chart_has_uv", f"{(count + 7) // 8} bytes", len(data))
    bits = np.unpackbits(np.frombuffer(data, np.uint8)).astype(np.bool_)
    if bits[count:].any():
        raise record.error("chart_has_uv", "zeros after the last chart", "a set bit")
    return bits[:count]
