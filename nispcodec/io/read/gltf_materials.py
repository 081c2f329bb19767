"""glTF 2.0 materials, and which texture coordinates their maps look up."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from urllib.parse import unquote

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.core.asset import Material, TextureMap
from nispcodec.core.errors import MeshError
from nispcodec.core.slots import BY_NAME, SLOT_TABLE
from nispcodec.io.folder import Folder
from nispcodec.io.images import TextureShelf
from nispcodec.io.read.gltf_buffers import Buffers, read_uri
from nispcodec.io.read.gltf_json import Element
from nispcodec.io.read.names import material_name

_WRAPS = {10497: "repeat", 33071: "clamp", 33648: "mirror"}
_FILTERS = {9728: "nearest", 9729: "linear"}
_IMAGE_EXTENSIONS = ("EXT_texture_webp", "EXT_texture_avif")
_BASISU = "KHR_texture_basisu"
_GLOSSY = "KHR_materials_pbrSpecularGlossiness"


@dataclass(frozen=True)
class UvSource:
    """A set of texture coordinates and its transform as in KHR_texture_transform.

    `rotation` is in radians; `texcoord` is the number of TEXCOORD_n.
    """

    texcoord: int = 0
    offset: tuple[float, ...] = (0.0, 0.0)
    rotation: float = 0.0
    scale: tuple[float, ...] = (1.0, 1.0)

    def apply(self, uvs: Float64Array) -> Float64Array:
        """UVs (n, 2) as in the file -> (n, 2) as looked up; both have their origin top-left.

        NaN or infinity where they overflow.
        """
        if self.offset == (0.0, 0.0) and not self.rotation and self.scale == (1.0, 1.0):
            return uvs
        # The extension's text turns counter-clockwise as seen, with v pointing down. Its GLSL
        # turns the other way, but its example and all known viewers follow the text.
        cosine, sine = math.cos(self.rotation), math.sin(self.rotation)
        turn = np.array([[cosine, sine], [-sine, cosine]])
        with np.errstate(over="ignore", invalid="ignore"):
            moved: Float64Array = (uvs * self.scale) @ turn.T + self.offset
        return moved


class GltfMaterials:
    """The materials that primitives use, numbered in the order of their first use.

    `shelf` gathers their textures. What cannot be kept of a material is said in `warnings`.
    """

    def __init__(
        self, root: Element, buffers: Buffers, folder: Folder, warnings: list[str]
    ) -> None:
        self.shelf = TextureShelf(warnings)
        self._root = root
        self._buffers = buffers
        self._folder = folder
        self._warnings = warnings
        self._images: dict[int, int | None] = {}
        self._made: dict[int | None, tuple[Material, UvSource]] = {}

    def use(self, index: int | None) -> tuple[int, UvSource]:
        """The number of material `index` of the file, None being the default one, and its UVs.

        Raises MeshError for a malformed material.
        """
        if index not in self._made:
            self._made[index] = self._make(index)
        return list(self._made).index(index), self._made[index][1]

    @property
    def materials(self) -> tuple[Material, ...]:
        """The materials used so far; at least one."""
        return tuple(material for material, _ in self._made.values()) or (Material(),)

    def _make(self, index: int | None) -> tuple[Material, UvSource]:
        if index is None:
            return Material(metallic=1.0), UvSource()
        source = _without_nan(self._root.entry("materials", index), self._warnings)
        glossy = _glossy(source)
        self._warn_of_extensions(source, glossy is not None)
        red, green, blue = source.numbers("emissiveFactor", (0.0, 0.0, 0.0))
        infos, uvs = self._of_one_source(dict(_texture_infos(source, glossy)), source)
        factors = _glossy_factors(glossy) if glossy else _metallic_factors(source)
        material = Material(
            name=material_name(source.text("name", ""), self._warnings) or f"material_{index}",
            base_color=factors[0],
            metallic=factors[1],
            roughness=factors[2],
            emissive=(_unit(red), _unit(green), _unit(blue)),
            alpha_mode=_alpha_mode(source),
            alpha_cutoff=_unit(source.number("alphaCutoff", 0.5)),
            double_sided=source.flag("doubleSided"),
            maps=self._maps(infos),
        )
        return material, uvs

    def _maps(self, infos: dict[str, Element]) -> dict[str, TextureMap]:
        made = {slot: self._map(slot, info) for slot, info in infos.items()}
        return {slot: used for slot, used in made.items() if used is not None}

    def _map(self, slot: str, info: Element) -> TextureMap | None:
        texture = self._root.entry("textures", info.integer("index"))
        place = self._place(texture)
        if place is None:
            return None
        key = BY_NAME[slot].gltf_strength
        strength = info.number(key, 1.0) if key else 1.0
        wrap, texture_filter = self._sampling(texture)
        return TextureMap(place, wrap, texture_filter, strength)

    def _place(self, texture: Element) -> int | None:
        """The place on the shelf of the first of a texture's images that can be read."""
        images = self._image_indices(texture)
        if not images:
            self._warnings.append(f"{texture.place}: holds no image that we can read")
        for image in images:
            if image not in self._images:
                self._images[image] = self._image(image)
            if self._images[image] is not None:
                return self._images[image]
        return None

    def _image_indices(self, texture: Element) -> list[int]:
        """The same picture as WebP, AVIF, PNG or JPEG, or KTX2; what `source` has is the whole."""
        found = [(texture.extension(name), name) for name in (*_IMAGE_EXTENSIONS, _BASISU)]
        indices = {name: each.integer("source") for each, name in found if each is not None}
        basisu = indices.pop(_BASISU, None)
        ordered = [*indices.values(), texture.optional("source"), basisu]
        return [index for index in ordered if index is not None]

    def _image(self, index: int) -> int | None:
        image = self._root.entry("images", index)
        uri = image.text("uri", "")
        try:
            data = self._image_bytes(image, uri)
        except MeshError as why:
            self._warnings.append(f"{why}: image left out")
            return None
        shown = "" if uri.startswith("data:") else unquote(uri)
        name = shown or image.text("name", "") or f"image_{index}"
        if data is None:
            self._warnings.append(f"{image.place}: image {name!r} not found")
            return None
        return self.shelf.add(name, data, f"{image.place} ({name})")

    def _image_bytes(self, image: Element, uri: str) -> bytes | None:
        if uri:
            return read_uri(uri, self._folder, image.place)
        return bytes(self._buffers.view(image.integer("bufferView")))

    def _sampling(self, texture: Element) -> tuple[tuple[str, str], str]:
        index = texture.optional("sampler")
        if index is None:
            return ("repeat", "repeat"), "linear"
        sampler = self._root.entry("samplers", index)
        modes = [sampler.integer(key, 10497) for key in ("wrapS", "wrapT")]
        if not set(modes) <= set(_WRAPS):
            sampler.fail(f"wraps of {list(_WRAPS)}", modes)
        chosen = _FILTERS.get(sampler.integer("magFilter", 9729), "linear")
        return (_WRAPS[modes[0]], _WRAPS[modes[1]]), chosen

    def _of_one_source(
        self, infos: dict[str, Element], material: Element
    ) -> tuple[dict[str, Element], UvSource]:
        """The maps that use the base color's UVs, else those of the first map, and these UVs.

        A mesh has one set of UVs: a map with others would be looked up in wrong places.
        """
        sources = {slot: _uv_source(info) for slot, info in infos.items()}
        first = next(iter(sources), "")
        kept = {slot: info for slot, info in infos.items() if sources[slot] == sources[first]}
        if len(kept) < len(infos):
            others = ", ".join(slot for slot in infos if slot not in kept)
            self._warnings.append(
                f"{material.place}: left out the maps for {others}: "
                f"they use other texture coordinates than {first}"
            )
        return kept, sources.get(first, UvSource())

    def _warn_of_extensions(self, material: Element, glossy: bool) -> None:
        if glossy:
            self._warnings.append(
                f"{material.place}: specular-glossiness turned into diffuse and roughness"
            )
        extensions = material.get("extensions")
        names = extensions.value if extensions and isinstance(extensions.value, dict) else {}
        self._warnings.extend(
            f"{material.place}: extension {name!r} is left out"
            for name in names
            if not (glossy and name == _GLOSSY)
        )


def _glossy(material: Element) -> Element | None:
    """The specular-glossiness of a material, where its metallic-roughness has no picture to show.

    Exporters that write both often leave the images to the older one.
    """
    glossy = material.extension(_GLOSSY)
    pbr = material.get("pbrMetallicRoughness")
    if glossy is None or pbr is None:
        return glossy
    pictured = glossy.get("diffuseTexture") is not None and pbr.get("baseColorTexture") is None
    return glossy if pictured else None


def _without_nan(material: Element, warnings: list[str]) -> Element:
    """The material without factors of NaN or infinity, which are no JSON but are written."""
    value, lost = _finite_members(material.value)
    if lost:
        warnings.append(f"{material.place}: {', '.join(lost)} no finite numbers: left out")
    return replace(material, value=value)


def _finite_members(value: object, depth: int = 3) -> tuple[object, list[str]]:
    """The value without members that are not finite, down to `depth` objects, and their names."""
    if not isinstance(value, dict) or depth == 0:
        return value, []
    kept: dict[str, object] = {}
    lost: list[str] = []
    for key, member in value.items():
        numbers = member if isinstance(member, list) else [member]
        if any(isinstance(each, float) and not math.isfinite(each) for each in numbers):
            lost.append(key)
            continue
        kept[key], further = _finite_members(member, depth - 1)
        lost += further
    return kept, lost


def _texture_infos(material: Element, glossy: Element | None) -> Iterator[tuple[str, Element]]:
    """Slot and textureInfo of each map, base color first."""
    for slot in SLOT_TABLE:
        owner = material.get(slot.gltf_owner) if slot.gltf_owner else material
        info = None if owner is None else owner.get(slot.gltf_key)
        if slot.name == "base_color" and glossy is not None:
            info = glossy.get("diffuseTexture") or info
        if info is not None:
            yield slot.name, info


Factors = tuple[tuple[float, float, float, float], float, float]


def _metallic_factors(material: Element) -> Factors:
    """Base color, metallic, roughness."""
    pbr = material.get("pbrMetallicRoughness") or Element({}, material.file, material.path)
    color = _color(pbr, "baseColorFactor")
    return (
        color,
        _unit(pbr.number("metallicFactor", 1.0)),
        _unit(pbr.number("roughnessFactor", 1.0)),
    )


def _glossy_factors(glossy: Element) -> Factors:
    roughness = 1.0 - _unit(glossy.number("glossinessFactor", 1.0))
    return _color(glossy, "diffuseFactor"), 0.0, roughness


def _color(owner: Element, key: str) -> tuple[float, float, float, float]:
    red, green, blue, alpha = owner.numbers(key, (1.0, 1.0, 1.0, 1.0))
    return _unit(red), _unit(green), _unit(blue), _unit(alpha)


def _alpha_mode(material: Element) -> str:
    mode = material.text("alphaMode", "OPAQUE").lower()
    return mode if mode in ("opaque", "mask", "blend") else material.fail("an alphaMode", mode)


def _uv_source(info: Element) -> UvSource:
    texcoord = info.integer("texCoord", 0)
    moved = info.extension("KHR_texture_transform")
    if moved is None:
        return UvSource(texcoord)
    return UvSource(
        moved.integer("texCoord", texcoord),
        moved.numbers("offset", (0.0, 0.0)),
        moved.number("rotation", 0.0),
        moved.numbers("scale", (1.0, 1.0)),
    )


def _unit(value: float) -> float:
    return min(max(value, 0.0), 1.0)
