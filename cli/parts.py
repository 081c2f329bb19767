"""What an asset is held as, part by part, and why: in bytes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .report import number

if TYPE_CHECKING:
    from nispcodec.core.document import Document, Field
    from nispcodec.core.mesh_part import MeshPart


def parts_of(document: Document, data: bytes) -> list[dict[str, Any]]:
    """A name, what is in it and its bytes in the file for the field and for every mesh part."""
    from nispcodec.format import inspect
    from nispcodec.format.constants import MESH, NETS
    from nispcodec.format.mesh import encode

    stored = {each.code: each.stored_length for each in inspect(data)}
    sizes = [len(encode((each,))) for each in document.meshes]
    # Parts are coded one after the other: each alone says what share is its own.
    whole = stored.get(MESH, 0) / max(sum(sizes), 1)
    field = [_field(document.field, stored[NETS])] if document.field else []
    return field + [
        _mesh(number, part, round(size * whole))
        for number, (part, size) in enumerate(zip(document.meshes, sizes, strict=True), 1)
    ]


def why(document: Document) -> str:
    """One line: what the asset is held as, and about what the other form would take."""
    forms = {"field (networks)": document.field, "mesh (triangles)": document.meshes}
    held = " and ".join(name for name, there in forms.items() if there)
    other = document.info.get("other_form_bytes")
    if not isinstance(other, int | float) or not other:
        return held
    rest = "triangles" if document.field else "networks"
    told = f"{held}; as {rest} about {number(round(other))} bytes at the same distance"
    made_up = document.info.get("other_form_made_up_share")
    if not isinstance(made_up, int | float) or not made_up:
        return told
    return f"{told}, but with {100 * made_up:.2g} % of made-up surface"


def _field(field: Field, size: int) -> dict[str, Any]:
    return {
        "name": "field",
        "networks": list(field.networks),
        "charts": len(field.charts),
        "bytes": size,
        "half_thickness": field.half_thickness,
    }


def _mesh(number: int, part: MeshPart, size: int) -> dict[str, Any]:
    return {
        "name": f"mesh {number}",
        "triangles": len(part.faces),
        "vertices": len(part.positions),
        "charts": len(part.chart_materials),
        "copies": len(part.placements),
        "bytes": size,
        "sheet_share": round(float(part.sheet.mean()), 4),
        "step": part.step,
    }
