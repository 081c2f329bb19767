"""What an asset is held as, part by part, and why: in bytes, and, where known, in errors."""

from __future__ import annotations

from collections.abc import Iterable
from math import isfinite
from typing import TYPE_CHECKING, Any

from .report import number

if TYPE_CHECKING:
    from nispcodec.core.document import Document, Field
    from nispcodec.core.mesh_part import MeshPart


def parts_of(document: Document, data: bytes) -> list[dict[str, Any]]:
    """For the field and for every mesh part a name, why it is one, what is in it, and its bytes."""
    from nispcodec.format import inspect
    from nispcodec.format.constants import MESH, NETS
    from nispcodec.format.mesh import encode

    stored = {each.code: each.stored_length for each in inspect(data)}
    sizes = [len(encode((each,))) for each in document.meshes]
    # Parts are coded one after the other: each alone says what share is its own.
    whole = stored.get(MESH, 0) / max(sum(sizes), 1)
    both = bool(document.field and document.meshes)
    field = [_field(document.field, stored[NETS], both)] if document.field else []
    return field + [
        _mesh(number, part, round(size * whole), both)
        for number, (part, size) in enumerate(zip(document.meshes, sizes, strict=True), 1)
    ]


def with_errors(
    parts: list[dict[str, Any]], errors: Iterable[tuple[float, float]]
) -> list[dict[str, Any]]:
    """The same, with what an encode has measured of each: it is not in the file."""
    names = ("distance_error", "uv_error")
    told = [
        {
            name: float(f"{value:.3g}")
            for name, value in zip(names, each, strict=True)
            if isfinite(value)
        }
        for each in errors
    ]
    return [part | more for part, more in zip(parts, told, strict=True)] if told else parts


def in_a_line(part: dict[str, Any]) -> str:
    """A part for who reads an encode's report: why it is one, its bytes and its errors."""
    off = ""
    if "distance_error" in part:
        off = f", {part['distance_error']:g} off, UVs {part['uv_error']:g}"
    return f"{part['name']}: {number(part['bytes'])} bytes{off}; {part['why']}"


def why(document: Document) -> str:
    """One line: what the asset is held as, and about what the other form would take."""
    forms = {"field (networks)": document.field, "mesh (triangles)": document.meshes}
    held = " and ".join(name for name, there in forms.items() if there)
    other = document.info.get("other_form_bytes")
    if not isinstance(other, int | float) or not other:
        return held
    rest = "triangles" if document.field else "networks"
    told = f"{held}; as {rest} about {number(round(other))} bytes"
    made_up = document.info.get("other_form_made_up_share")
    if not isinstance(made_up, int | float) or not made_up:
        return told
    return f"{told}, but with {100 * made_up:.2g} % of made-up surface"


def _field(field: Field, size: int, both: bool) -> dict[str, Any]:
    return {
        "name": "field",
        "why": "dense and smooth bodies" if both else "the whole asset",
        "networks": list(field.networks),
        "charts": len(field.charts),
        "bytes": size,
        "half_thickness": field.half_thickness,
    }


def _mesh(number: int, part: MeshPart, size: int, both: bool) -> dict[str, Any]:
    return {
        "name": f"mesh {number}",
        "why": _mesh_why(part, both),
        "triangles": len(part.faces),
        "vertices": len(part.positions),
        "charts": len(part.chart_materials),
        "copies": len(part.placements),
        "bytes": size,
        "sheet_share": round(float(part.sheet.mean()), 4),
        "step": part.step,
    }


def _mesh_why(part: MeshPart, both: bool) -> str:
    """Copies have parts of their own; beside a field there is what does not suit one."""
    if len(part.placements) > 1:
        return f"held once for {len(part.placements)} copies"
    if part.sheet.all():
        return "sheets, which have no inside"
    return "bodies of few faces, and sheets" if both else "all that has no copies"
