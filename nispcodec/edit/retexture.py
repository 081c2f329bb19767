"""Another image in a material's slot: networks, charts and all other textures stay as they are."""

from __future__ import annotations

from dataclasses import replace

from nispcodec.core.asset import Material, Texture
from nispcodec.core.document import Document
from nispcodec.core.errors import NispError
from nispcodec.core.slots import SLOTS
from nispcodec.io.images import TextureShelf


def retextured(
    document: Document, slot: str, data: bytes, name: str, material: str | None = None
) -> tuple[Document, tuple[str, ...]]:
    """The document with the image file `data` in `slot` of a material, and warnings.

    `name` is the image's file name. Without `material` it goes to the materials that have a texture
    in that slot; they must share it. Wrap, filter and strength stay. A texture that nothing uses
    any more is dropped. Raises NispError for a slot or material that is not there, and for an image
    that cannot be read.
    """
    chosen = _materials(document, slot, material)
    warnings: list[str] = []
    shelf = TextureShelf(warnings)
    shelf.textures = list(document.textures)
    index = shelf.add(name, data, name)
    if index is None:
        raise NispError(warnings[0].removesuffix(": left out"))
    materials = tuple(
        _with_texture(each, slot, index) if number in chosen else each
        for number, each in enumerate(document.materials)
    )
    return _without_unused(document, materials, tuple(shelf.textures)), tuple(warnings)


def _materials(document: Document, slot: str, name: str | None) -> set[int]:
    """Which materials get the image."""
    if slot not in SLOTS:
        raise NispError(f"slot: expected one of {', '.join(SLOTS)}, found {slot!r}")
    numbered = list(enumerate(document.materials))
    if name is not None and all(each.name != name for _, each in numbered):
        known = ", ".join(repr(each.name) for _, each in numbered)
        raise NispError(f"material: expected one of {known}, found {name!r}")
    chosen = {n for n, each in numbered if name in (None, each.name) and slot in each.maps}
    if not chosen:
        there = sorted({used for _, each in numbered for used in each.maps}) or ["none at all"]
        raise NispError(f"slot {slot}: expected a texture there, found {', '.join(there)}")
    if name is None and len({document.materials[n].maps[slot].texture for n in chosen}) > 1:
        found = ", ".join(repr(document.materials[n].name) for n in sorted(chosen))
        raise NispError(f"slot {slot}: expected a material to be named, found {found}")
    return chosen


def _with_texture(material: Material, slot: str, texture: int) -> Material:
    used = replace(material.maps[slot], texture=texture)
    return replace(material, maps={**material.maps, slot: used})


def _without_unused(
    document: Document, materials: tuple[Material, ...], textures: tuple[Texture, ...]
) -> Document:
    used = sorted({each.texture for material in materials for each in material.maps.values()})
    numbers = {old: new for new, old in enumerate(used)}
    renumbered = tuple(
        replace(
            material,
            maps={
                slot: replace(each, texture=numbers[each.texture])
                for slot, each in material.maps.items()
            },
        )
        for material in materials
    )
    kept = tuple(textures[old] for old in used)
    return replace(document, materials=renumbered, textures=kept)
