"""The META section: everything of a document but the weights, the images and the measurements."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from nispcodec.asset import (
    ALPHA_MODES,
    FILTERS,
    MIME_TYPES,
    SLOTS,
    WRAPS,
    Material,
    Texture,
    TextureMap,
)
from nispcodec.document import ChartTable, Document, Frame
from nispcodec.errors import FormatError
from nispcodec.format import canonical
from nispcodec.format.constants import META, NETWORKS
from nispcodec.format.record import Record, sparse
from nispcodec.network import (
    ACTIVATIONS,
    CONDITIONINGS,
    ENCODINGS,
    MAX_CHARTS,
    OUTPUTS,
    NetworkSpec,
)

_ONES = (1.0, 1.0, 1.0, 1.0)
_BLACK = (0.0, 0.0, 0.0)
_UV_MAP = (0.0, 0.0, 1.0, 1.0)


@dataclass(frozen=True)
class Metadata:
    """What META holds; `textures` are (name, mime, length of the image in TXTR)."""

    frame: Frame
    charts: ChartTable
    materials: tuple[Material, ...]
    textures: tuple[tuple[str, str, int], ...]
    specs: dict[str, NetworkSpec]
    shell: float


def encode(document: Document) -> bytes:
    """The bytes of META."""
    table = document.charts
    kinds = sorted({int(index) for index in table.materials})
    fields: dict[int, tuple[Any, Any]] = {
        1: ([float(x) for x in (*document.frame.center, document.frame.radius)], None),
        2: (
            {
                1 + NETWORKS.index(name): _spec_fields(name, network.spec)
                for name, network in document.networks.items()
            },
            None,
        ),
        3: (len(table), 1),
        4: (b"" if kinds == [0] else _chart_materials(table, len(document.materials)), b""),
        5: (b"" if table.has_uv.all() else np.packbits(table.has_uv).tobytes(), b""),
        6: ([float(x) for x in (*table.uv_offset, *table.uv_scale)], list(_UV_MAP)),
        7: ([_material_fields(material) for material in document.materials], [{}]),
        8: ([_texture_fields(texture) for texture in document.textures], []),
        9: (float(document.shell), 0.0),
    }
    return canonical.encode(META, sparse(fields))


def decode(data: bytes) -> Metadata:
    """The content of META, each field checked; the relations between them are `Document`'s."""
    record = Record(META, "document", canonical.decode(META, data))
    x, y, z, radius = record.floats(1, "frame", 4)
    networks = Record(META, "networks", record.take(2, "networks", dict))
    count = record.take(3, "charts", int, 1)
    if not 1 <= count <= MAX_CHARTS:
        raise record.error("charts", f"1 to {MAX_CHARTS}", count)
    specs = {
        name: _read_spec(name, networks.take(key, name, dict), count)
        for key, name in enumerate(NETWORKS, 1)
        if key in networks
    }
    networks.finish()
    materials = _read_materials(record)
    metadata = Metadata(
        frame=Frame((x, y, z), radius),
        charts=_read_charts(record, count, len(materials)),
        materials=materials,
        textures=_read_textures(record),
        specs=specs,
        shell=record.take(9, "shell", float, 0.0),
    )
    record.finish()
    return metadata


def _spec_fields(name: str, spec: NetworkSpec) -> dict[int, Any]:
    if name != "uv" and spec.conditioning != "none":
        raise FormatError(META, f"{name}.conditioning", "none", spec.conditioning)
    return sparse(
        {
            1: (list(spec.hidden), None),
            2: (1 + ENCODINGS.index(spec.encoding), 1),
            3: (spec.levels, 0),
            4: (1 + CONDITIONINGS.index(spec.conditioning), 1),
            5: (spec.embedding, 0),
            6: (1 + ACTIVATIONS.index(spec.activation), 1),
            7: (float(spec.w0), 30.0),
            8: (1 + OUTPUTS.index(spec.output), 1),
        }
    )


def _read_spec(name: str, value: Any, charts: int) -> NetworkSpec:
    record = Record(META, f"networks.{name}", value)
    hidden = record.take(1, "hidden", list)
    if not all(type(width) is int for width in hidden):
        raise record.error("hidden", "integers", hidden)
    encoding = record.member(2, "encoding", ENCODINGS, "identity")
    levels = record.take(3, "levels", int, 0)
    conditioning = record.member(4, "conditioning", CONDITIONINGS, "none")
    if name != "uv" and conditioning != "none":
        raise record.error("conditioning", "none", conditioning)
    spec = NetworkSpec(
        hidden=tuple(hidden),
        outputs={"sdf": 1, "chart": charts, "uv": 2}[name],
        encoding=encoding,
        levels=levels,
        conditioning=conditioning,
        charts=0 if conditioning == "none" else charts,
        embedding=record.take(5, "embedding", int, 0),
        activation=record.member(6, "activation", ACTIVATIONS, "sine"),
        w0=record.take(7, "w0", float, 30.0),
        output=record.member(8, "output", OUTPUTS, "identity"),
    )
    record.finish()
    return spec


def _index_type(materials: int) -> np.dtype[Any]:
    return np.dtype("u1") if materials <= 256 else np.dtype("<u2")


def _chart_materials(table: ChartTable, materials: int) -> bytes:
    return table.materials.astype(_index_type(materials)).tobytes()


def _read_charts(record: Record, count: int, materials: int) -> ChartTable:
    kind = _index_type(materials)
    indices = record.take(4, "chart materials", bytes, b"") or bytes(count * kind.itemsize)
    if len(indices) != count * kind.itemsize:
        raise record.error("chart materials", f"{count * kind.itemsize} bytes", len(indices))
    flags = (
        record.take(5, "chart has_uv", bytes, b"") or np.packbits(np.ones(count, bool)).tobytes()
    )
    bits = np.unpackbits(np.frombuffer(flags, np.uint8))
    if len(bits) != (count + 7) // 8 * 8 or bits[count:].any():
        raise record.error("chart has_uv", f"{count} bits, then zeros", f"{len(bits)} bits")
    uv_map = record.floats(6, "uv map", 4, _UV_MAP)
    return ChartTable(
        materials=np.frombuffer(indices, kind).astype(np.int32),
        has_uv=bits[:count].astype(bool),
        uv_offset=(uv_map[0], uv_map[1]),
        uv_scale=(uv_map[2], uv_map[3]),
    )


def _material_fields(material: Material) -> dict[int, Any]:
    maps = {1 + SLOTS.index(slot): _map_fields(used) for slot, used in material.maps.items()}
    return sparse(
        {
            1: (material.name, "material"),
            2: ([float(x) for x in material.base_color], list(_ONES)),
            3: (float(material.metallic), 0.0),
            4: (float(material.roughness), 1.0),
            5: ([float(x) for x in material.emissive], list(_BLACK)),
            6: (1 + ALPHA_MODES.index(material.alpha_mode), 1),
            7: (float(material.alpha_cutoff), 0.5),
            8: (material.double_sided, False),
            9: (maps, {}),
        }
    )


def _read_materials(record: Record) -> tuple[Material, ...]:
    values = record.take(7, "materials", list, [{}])
    return tuple(
        _read_material(Record(META, f"materials.{index}", value))
        for index, value in enumerate(values)
    )


def _read_material(record: Record) -> Material:
    red, green, blue, alpha = record.floats(2, "base_color", 4, _ONES)
    glow_red, glow_green, glow_blue = record.floats(5, "emissive", 3, _BLACK)
    maps = Record(META, f"{record.path}.maps", record.take(9, "maps", dict, {}))
    material = Material(
        name=record.take(1, "name", str, "material"),
        base_color=(red, green, blue, alpha),
        metallic=record.take(3, "metallic", float, 0.0),
        roughness=record.take(4, "roughness", float, 1.0),
        emissive=(glow_red, glow_green, glow_blue),
        alpha_mode=record.member(6, "alpha_mode", ALPHA_MODES, "opaque"),
        alpha_cutoff=record.take(7, "alpha_cutoff", float, 0.5),
        double_sided=record.take(8, "double_sided", bool, False),
        maps={
            slot: _read_map(Record(META, f"{maps.path}.{slot}", maps.take(key, slot, dict)))
            for key, slot in enumerate(SLOTS, 1)
            if key in maps
        },
    )
    maps.finish()
    record.finish()
    return material


def _map_fields(used: TextureMap) -> dict[int, Any]:
    return sparse(
        {
            1: (used.texture, 0),
            2: (1 + WRAPS.index(used.wrap[0]), 1),
            3: (1 + WRAPS.index(used.wrap[1]), 1),
            4: (1 + FILTERS.index(used.filter), 1),
            5: (float(used.strength), 1.0),
        }
    )


def _read_map(record: Record) -> TextureMap:
    used = TextureMap(
        texture=record.take(1, "texture", int, 0),
        wrap=(
            record.member(2, "wrap u", WRAPS, "repeat"),
            record.member(3, "wrap v", WRAPS, "repeat"),
        ),
        filter=record.member(4, "filter", FILTERS, "linear"),
        strength=record.take(5, "strength", float, 1.0),
    )
    record.finish()
    return used


def _texture_fields(texture: Texture) -> dict[int, Any]:
    mime = 1 + MIME_TYPES.index(texture.mime)
    return sparse({1: (texture.name, None), 2: (mime, 1), 3: (len(texture.data), None)})


def _read_textures(record: Record) -> tuple[tuple[str, str, int], ...]:
    return tuple(
        _read_texture(Record(META, f"textures.{index}", value))
        for index, value in enumerate(record.take(8, "textures", list, []))
    )


def _read_texture(record: Record) -> tuple[str, str, int]:
    name = record.take(1, "name", str)
    mime = record.member(2, "mime", MIME_TYPES, "image/png")
    length = record.take(3, "length", int)
    record.finish()
    return name, mime, length
