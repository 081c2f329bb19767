"""Materials and texture descriptions in META."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from nispcodec.core.asset import (
    ALPHA_MODES,
    FILTERS,
    MIME_TYPES,
    WRAPS,
    Material,
    Texture,
    TextureMap,
)
from nispcodec.core.errors import FormatError
from nispcodec.core.slots import SLOTS
from nispcodec.format.constants import ENDINGS, MAX_FILE, MAX_ITEMS, META
from nispcodec.format.record import Record, check_file_name, check_text, number, sparse

_WHITE = (1.0, 1.0, 1.0, 1.0)
_BLACK = (0.0, 0.0, 0.0)
_ENDING = dict(zip(MIME_TYPES, ENDINGS, strict=True))


def encode_material(material: Material) -> dict[int, Any]:
    """A material -> its map in META. Raises FormatError for what META cannot hold."""
    path = f"materials.{material.name}"
    check_text(META, f"{path}.name", material.name)
    maps = {
        number(META, f"{path}.maps", slot, SLOTS): _encode_map(f"{path}.maps.{slot}", used)
        for slot, used in material.maps.items()
    }
    return sparse(
        {
            1: (material.name, "material"),
            2: ([float(x) for x in material.base_color], list(_WHITE)),
            3: (float(material.metallic), 0.0),
            4: (float(material.roughness), 1.0),
            5: ([float(x) for x in material.emissive], list(_BLACK)),
            6: (number(META, f"{path}.alpha_mode", material.alpha_mode, ALPHA_MODES), 1),
            7: (float(material.alpha_cutoff), 0.5),
            8: (bool(material.double_sided), False),
            9: (maps, {}),
        }
    )


def decode_material(index: int, value: Any) -> Material:
    """A map in META -> material `index` of the file. Raises FormatError for a malformed field."""
    record = Record(META, f"materials.{index}", value)
    red, green, blue, alpha = record.floats(2, "base_color", 4, _WHITE)
    glow_red, glow_green, glow_blue = record.floats(5, "emissive", 3, _BLACK)
    maps = Record(META, f"{record.path}.maps", record.take(9, "maps", dict, {}))
    material = Material(
        name=record.text(1, "name", "material"),
        base_color=(red, green, blue, alpha),
        metallic=record.take(3, "metallic", float, 0.0),
        roughness=record.take(4, "roughness", float, 1.0),
        emissive=(glow_red, glow_green, glow_blue),
        alpha_mode=record.member(6, "alpha_mode", ALPHA_MODES),
        alpha_cutoff=record.take(7, "alpha_cutoff", float, 0.5),
        double_sided=record.take(8, "double_sided", bool, False),
        maps={
            slot: _decode_map(Record(META, f"{maps.path}.{slot}", maps.take(key, slot, dict)))
            for key, slot in enumerate(SLOTS, 1)
            if key in maps
        },
    )
    maps.finish()
    record.finish()
    return material


def encode_textures(textures: Sequence[Texture]) -> list[dict[int, Any]]:
    """The map in META of every texture; the bytes go to TXTR, whose end is that of the last.

    Raises FormatError for a name that is no bare file name with an ending, an unknown type, and an
    image without bytes.
    """
    fields = [_encode_texture(texture) for texture in textures]
    for each, texture in zip(fields[:-1], textures, strict=False):
        each[3] = len(texture.data)
    return fields


def decode_textures(values: list[Any]) -> tuple[tuple[str, str, int | None], ...]:
    """Maps in META -> name, mime type and length in bytes of every texture.

    The length of the last is None: it is what is left of TXTR. Raises FormatError for a malformed
    field.
    """
    return tuple(
        _decode_texture(Record(META, f"textures.{index}", value), index == len(values) - 1)
        for index, value in enumerate(values)
    )


def _encode_texture(texture: Texture) -> dict[int, Any]:
    path = f"textures.{texture.name}"
    check_file_name(META, f"{path}.name", texture.name)
    if not texture.data:
        raise FormatError(META, f"{path}.length", "at least 1 byte", 0)
    if "." not in texture.name:
        raise FormatError(META, f"{path}.name", "a file name with an ending", texture.name)
    mime = number(META, f"{path}.mime", texture.mime, MIME_TYPES)
    return sparse({1: (_stored_name(texture.name, texture.mime), None), 2: (mime, 1)})


def _decode_texture(record: Record, last: bool) -> tuple[str, str, int | None]:
    stored = record.text(1, "name")
    mime = record.member(2, "mime", MIME_TYPES)
    name = stored if "." in stored else stored + _ENDING[mime]
    check_file_name(META, f"{record.path}.name", stored)
    if _stored_name(name, mime) != stored:
        raise record.error("name", f"no ending, being {_ENDING[mime]}", repr(stored))
    length = None if last else record.integer(3, "length", 1, MAX_FILE)
    record.finish()
    return name, mime, length


def _stored_name(name: str, mime: str) -> str:
    """Without the ending that its type has, if that leaves no dot."""
    stem = name.removesuffix(_ENDING[mime])
    return name if stem == "" or "." in stem else stem


def _encode_map(path: str, used: TextureMap) -> dict[int, Any]:
    return sparse(
        {
            1: (used.texture, 0),
            2: (number(META, f"{path}.wrap_u", used.wrap[0], WRAPS), 1),
            3: (number(META, f"{path}.wrap_v", used.wrap[1], WRAPS), 1),
            4: (number(META, f"{path}.filter", used.filter, FILTERS), 1),
            5: (float(used.strength), 1.0),
        }
    )


def _decode_map(record: Record) -> TextureMap:
    used = TextureMap(
        texture=record.integer(1, "texture", 0, MAX_ITEMS - 1, 0),
        wrap=(record.member(2, "wrap_u", WRAPS), record.member(3, "wrap_v", WRAPS)),
        filter=record.member(4, "filter", FILTERS),
        strength=record.take(5, "strength", float, 1.0),
    )
    record.finish()
    return used
