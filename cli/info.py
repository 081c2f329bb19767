"""`nisp info`: what is in a `.nisp` file."""

from __future__ import annotations

from itertools import compress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .report import print_group, print_json, rate

if TYPE_CHECKING:
    from nispcodec.core.asset import Material, Texture
    from nispcodec.core.document import Document
    from nispcodec.core.network import Network


@click.command("info", short_help="Show what a .nisp file holds.")
@click.argument("model", type=click.Path(path_type=Path))
@click.option("--textures", "listed", is_flag=True, help="The textures and who uses them, only.")
@click.option("--json", "as_json", is_flag=True, help="As JSON.")
def command(model: Path, listed: bool, as_json: bool) -> None:
    """Show MODEL's sections, bytes per part, networks, materials and textures.

    \b
    Example: nisp info model.nisp --json
    """
    from nispcodec.format import read

    document = read(model)
    facts = (
        {"textures": list_textures(document)} if listed else describe(document, model.read_bytes())
    )
    if as_json:
        print_json(facts)
    else:
        print_group(str(model), facts)


def describe(document: Document, data: bytes) -> dict[str, Any]:
    """Everything about a file that can be said without evaluating its networks."""
    return {
        "bytes": rate(data),
        "sections": _sections(data),
        "frame": {
            "center": list(document.frame.center),
            "radius": document.frame.radius,
        },
        "charts": len(document.charts),
        "half_thickness": document.half_thickness,
        "networks": {name: _network(each) for name, each in document.networks.items()},
        "materials": [_material(each) for each in document.materials],
        "textures": [
            {"name": each.name, "mime": each.mime, "bytes": len(each.data)}
            for each in document.textures
        ],
        "measured": dict(document.info),
    }


def list_textures(document: Document) -> list[dict[str, Any]]:
    """Every texture: its size in bytes and pixels, and the materials' slots that show it."""
    return [
        {
            "name": texture.name,
            "mime": texture.mime,
            "bytes": len(texture.data),
            "pixels": _pixels(texture),
            "used_by": ", ".join(
                f"{material.name}.{slot}"
                for material in document.materials
                for slot, used in material.maps.items()
                if used.texture == index
            ),
        }
        for index, texture in enumerate(document.textures)
    ]


def _pixels(texture: Texture) -> str:
    from nispcodec.core.texture import decode_image

    height, width = decode_image(texture).shape[:2]
    return f"{width} x {height}"


def _sections(data: bytes) -> list[dict[str, Any]]:
    from nispcodec.format import inspect

    return [
        {
            "name": each.code,
            "packing": each.packing,
            "offset": each.offset,
            "stored": each.stored_length,
            "decoded": each.decoded_length,
            **({"parts": dict(each.parts)} if each.parts else {}),
        }
        for each in inspect(data)
    ]


def _network(network: Network) -> dict[str, Any]:
    spec = network.spec
    layers = (spec.inputs, *spec.hidden, spec.outputs)
    facts = {
        "layers": "-".join(str(width) for width in layers),
        "weights": spec.weight_count,
        "activation": spec.activation,
        "encoding": spec.encoding,
        "quantized_tensors": f"{len(network.steps)} of {len(network.tensors)}",
    }
    if spec.conditioning != "none":
        facts["conditioning"] = spec.conditioning
    if spec.mirror:
        facts["mirror"] = "".join(compress("xyz", spec.mirrored))
    if spec.signed_axes:
        facts["signed_axes"] = "".join("xyz"[axis] for axis in spec.signed_axes)
    return facts


def _material(material: Material) -> dict[str, Any]:
    return {
        "name": material.name,
        "base_color": list(material.base_color),
        "alpha_mode": material.alpha_mode,
        "maps": {slot: used.texture for slot, used in material.maps.items()},
    }
