"""`nisp info`: what is in a `.nisp` file."""

from __future__ import annotations

from itertools import compress
from typing import TYPE_CHECKING, Any

import click

from .parts import parts_of, why
from .report import number, print_group, print_json, rate
from .sources import Source, model_argument, parsed
from .subcommand import json_option, subcommand

if TYPE_CHECKING:
    from nispcodec.core.asset import Material, Texture, TextureMap
    from nispcodec.core.document import Document
    from nispcodec.core.network import Network

Facts = dict[str, Any]


@subcommand("info", "Show what a .nisp file holds.")
@model_argument
@click.option("--textures", "listed", is_flag=True, help="The textures and who uses them, only.")
@json_option
def command(model: Source, listed: bool, as_json: bool) -> None:
    """Show what MODEL (.nisp, or - for standard input) holds.

    Sections, bytes per part, networks, materials with their maps and factors, textures, and what
    the encode says of itself.

    \b
    Example: nisp info model.nisp --json
    """
    data = model.read()
    document = parsed(data, model)
    facts = {"textures": list_textures(document)} if listed else describe(document, data)
    if as_json:
        print_json(facts)
    else:
        print_group(str(model), facts if listed else _for_people(facts))


def describe(document: Document, data: bytes) -> Facts:
    """Everything about a file that can be said without evaluating its networks."""
    return {
        "bytes": rate(data),
        "sections": _sections(data),
        "frame": {
            "center": list(document.frame.center),
            "radius": document.frame.radius,
        },
        "charts": len(document.chart_materials),
        "held_as": why(document),
        "parts": parts_of(document, data),
        "networks": {name: _network(each) for name, each in document.networks.items()},
        "materials": [_material(each, document) for each in document.materials],
        "textures": [_texture(each) for each in document.textures],
        "measured": dict(document.info),
    }


def list_textures(document: Document) -> list[Facts]:
    """Every texture: its size in bytes and pixels, and the materials' slots that show it."""
    return [
        {**_texture(texture), "used_by": _users(document, index)}
        for index, texture in enumerate(document.textures)
    ]


def _users(document: Document, texture: int) -> str:
    return ", ".join(
        f"{material.name}.{slot}"
        for material in document.materials
        for slot, used in material.maps.items()
        if used.texture == texture
    )


def _texture(texture: Texture) -> Facts:
    return {
        "name": texture.name,
        "mime": texture.mime,
        "bytes": len(texture.data),
        "pixels": _pixels(texture),
    }


def _pixels(texture: Texture) -> str:
    """`1024 x 512`; `nisp verify` says what is wrong with an image that has no size."""
    from nispcodec.core.errors import MeshError
    from nispcodec.core.texture import image_size

    try:
        width, height = image_size(texture)
    except MeshError:
        return "unreadable"
    return f"{width} x {height}"


def _sections(data: bytes) -> list[Facts]:
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


def _network(network: Network) -> Facts:
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


def _material(material: Material, document: Document) -> Facts:
    """The factors, which are linear, and the maps by slot."""
    cutoff = {"alpha_cutoff": material.alpha_cutoff} if material.alpha_mode == "mask" else {}
    return {
        "name": material.name,
        "base_color": list(material.base_color),
        "metallic": material.metallic,
        "roughness": material.roughness,
        "emissive": list(material.emissive),
        "alpha_mode": material.alpha_mode,
        **cutoff,
        "double_sided": material.double_sided,
        "maps": {slot: _map(used, document) for slot, used in material.maps.items()},
    }


def _map(used: TextureMap, document: Document) -> Facts:
    texture = _texture(document.textures[used.texture])
    return {
        "texture": used.texture,
        "image": texture.pop("name"),
        **texture,
        "wrap": list(used.wrap),
        "filter": used.filter,
        "strength": used.strength,
    }


def _for_people(facts: Facts) -> Facts:
    """The same with a line for each map and each texture, and what made the file apart."""
    measured = dict(facts["measured"])
    made = {name: measured.pop(name) for name in ("preset", "seed") if name in measured}
    materials = [_material_for_people(each) for each in facts["materials"]]
    textures = {each["name"]: _image(each) for each in facts["textures"]}
    told = {"encoded with": made or "not told", "measured": measured or "not told"}
    rest = {name: value for name, value in facts.items() if name != "measured"}
    return {**rest, "materials": materials, "textures": textures or "none", **told}


def _material_for_people(material: Facts) -> Facts:
    maps = {slot: f"{used['image']}, {_image(used)}" for slot, used in material["maps"].items()}
    return {**material, "maps": maps or "none"}


def _image(facts: Facts) -> str:
    return f"{facts['pixels']} pixels, {facts['mime']}, {number(facts['bytes'])} bytes"
