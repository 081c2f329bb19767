"""What META says, as the JSON beside a conformance file has it: by a reader or by the library."""

from __future__ import annotations

from typing import Any

from nispcodec.core.asset import Material
from nispcodec.core.document import Document
from tests.conformance import independent_meta

KEPT = ("frame", "charts", "uv_map", "half_thickness", "openings")
EXACT = 2**53
DIGITS = 7


def described(reader: Any) -> dict[str, Any]:
    """By the reader of the specification."""
    lengths = [len(file) for file in reader.files]
    materials = [
        sparse("materials", {**each, "maps": {k: sparse_map(v) for k, v in each["maps"].items()}})
        for each in reader.meta["materials"]
    ]
    return {
        **sparse("document", {name: reader.meta[name] for name in KEPT}),
        **meshes(reader.parts),
        "materials": materials,
        "textures": [
            {"name": each["name"], "mime": each["mime"], "length": length}
            for each, length in zip(reader.meta["textures"], lengths, strict=True)
        ],
        "info": {name: plain(value) for name, value in reader.meta["info"].items()},
    }


def by_the_library(document: Document) -> dict[str, Any]:
    """The same of a document."""
    frame = document.frame
    fields: dict[str, Any] = {"frame": [*frame.center, frame.radius]}
    if document.field:
        table = document.field.charts
        fields |= {
            "charts": len(table),
            "uv_map": [*table.uv_offset, *table.uv_scale],
            "half_thickness": document.field.half_thickness,
            "openings": table.openings,
        }
    return {
        **sparse("document", fields),
        **meshes([vars(part) for part in document.meshes]),
        "materials": [material(each) for each in document.materials],
        "textures": [
            {"name": each.name, "mime": each.mime, "length": len(each.data)}
            for each in document.textures
        ],
        "info": {name: plain(value) for name, value in document.info.items()},
    }


def meshes(parts: list[dict[str, Any]]) -> dict[str, Any]:
    """Of each mesh part how much there is of what, and its creases as numbers of sides."""
    found = [
        {
            "faces": len(part["faces"]),
            "charts": len(part["chart_materials"]),
            "placements": len(part["placements"]),
            "creases": [
                3 * face + corner
                for face, three in enumerate(part["creases"])
                for corner in range(3)
                if three[corner]
            ],
        }
        for part in parts
    ]
    return {"meshes": found} if found else {}


def material(each: Material) -> dict[str, Any]:
    """A material's fields, but for those of defaults."""
    maps = {
        slot: sparse_map(
            {
                "texture": used.texture,
                "wrap_u": used.wrap[0],
                "wrap_v": used.wrap[1],
                "filter": used.filter,
                "strength": used.strength,
            }
        )
        for slot, used in each.maps.items()
    }
    fields = {**vars(each), "maps": maps}
    lists = {name: list(v) if isinstance(v, tuple) else v for name, v in fields.items()}
    return sparse("materials", lists)


def sparse_map(fields: dict[str, Any]) -> dict[str, Any]:
    """A use of a texture, without defaults."""
    return sparse("materials.maps.slot", fields)


def sparse(table: str, fields: dict[str, Any]) -> dict[str, Any]:
    """The fields that do not have the default of a table of section 4."""
    defaults = independent_meta.defaults(table)
    return {name: value for name, value in fields.items() if value != defaults[name]}


def plain(value: Any) -> Any:
    """Integers that not every reader of JSON keeps are text, floats have `DIGITS` digits."""
    if type(value) is float:
        return float(f"{value:.{DIGITS}g}")
    return str(value) if type(value) is int and abs(value) > EXACT else value
