"""glTF 2.0 materials, and which texture coordinates their maps look up."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import TypeVar
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
_T = TypeVar("_T")
# Base color, metallic, roughness.
Factors = tuple[tuple[float, float, float, float], float, float]
# Pairs (n, k): TEXCOORD_n is the accessor that TEXCOORD_k is, k being the smaller.
SameUvs = tuple[tuple[int, int], ...]
_WHITE = (1.0, 1.0, 1.0, 1.0)


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

    `shelf` gathers their textures. What cannot be kept of a material is said in `warnings`, with
    its place, what was expected and what was found: it costs itself alone.
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
        self._made: dict[tuple[int | None, SameUvs], tuple[Material, UvSource]] = {}

    def use(self, index: int | None, same: SameUvs) -> tuple[int, UvSource]:
        """The number of material `index` of the file, None being the default one, and its UVs.

        `same` is of the primitive that has the material.
        """
        key = index, () if index is None else same
        if key not in self._made:
            default = Material(metallic=1.0), UvSource()
            self._made[key] = self._read(partial(self._make, index, dict(same)), default)
        return list(self._made).index(key), self._made[key][1]

    @property
    def materials(self) -> tuple[Material, ...]:
        """The materials used so far; at least one."""
        return tuple(material for material, _ in self._made.values()) or (Material(),)

    def _read(self, read: Callable[[], _T], default: _T) -> _T:
        """What `read` gives, or the default, with a warning, where the file is malformed."""
        try:
            return read()
        except MeshError as why:
            self._warnings.append(f"{why}: left out")
            return default

    def _make(self, index: int | None, same: dict[int, int]) -> tuple[Material, UvSource]:
        if index is None:
            return Material(metallic=1.0), UvSource()
        source = _without_nan(self._root.entry("materials", index), self._warnings)
        glossy = _glossy(source)
        self._warn_of_extensions(source, glossy is not None)
        red, green, blue = self._shares(source, "emissiveFactor", (0.0, 0.0, 0.0))
        infos, uvs = self._of_one_source(dict(_texture_infos(source, glossy)), source, same)
        factors = self._glossy_factors(glossy) if glossy else self._metallic_factors(source)
        material = Material(
            name=material_name(self._read(partial(source.text, "name", ""), ""), self._warnings)
            or f"material_{index}",
            base_color=factors[0],
            metallic=factors[1],
            roughness=factors[2],
            emissive=(red, green, blue),
            alpha_mode=self._read(partial(_alpha_mode, source), "opaque"),
            alpha_cutoff=self._share(source, "alphaCutoff", 0.5),
            double_sided=self._read(partial(source.flag, "doubleSided"), False),
            maps=self._maps(infos),
        )
        return material, uvs

    def _metallic_factors(self, material: Element) -> Factors:
        """Base color, metallic, roughness."""
        pbr = material.get("pbrMetallicRoughness") or Element({}, material.file, material.path)
        return (
            self._color(pbr, "baseColorFactor"),
            self._share(pbr, "metallicFactor", 1.0),
            self._share(pbr, "roughnessFactor", 1.0),
        )

    def _glossy_factors(self, glossy: Element) -> Factors:
        roughness = 1.0 - self._share(glossy, "glossinessFactor", 1.0)
        return self._color(glossy, "diffuseFactor"), 0.0, roughness

    def _color(self, owner: Element, key: str) -> tuple[float, float, float, float]:
        red, green, blue, alpha = self._shares(owner, key, _WHITE)
        return red, green, blue, alpha

    def _share(self, owner: Element, key: str, default: float) -> float:
        """A number from 0 to 1: others are cut to it, with a warning."""
        return self._cut(owner, key, (self._number(owner, key, default),))[0]

    def _shares(self, owner: Element, key: str, default: tuple[float, ...]) -> tuple[float, ...]:
        """As many numbers from 0 to 1 as the default has."""
        return self._cut(owner, key, self._read(partial(owner.numbers, key, default), default))

    def _cut(self, owner: Element, key: str, values: tuple[float, ...]) -> tuple[float, ...]:
        if not all(0 <= value <= 1 for value in values):
            found = ", ".join(f"{value:.9g}" for value in values)
            self._warnings.append(
                f"{owner.place}: expected {key} from 0 to 1, found {found}: cut to it"
            )
        return tuple(min(max(value, 0.0), 1.0) for value in values)

    def _number(self, owner: Element, key: str, default: float) -> float:
        return self._read(partial(owner.number, key, default), default)

    def _maps(self, infos: dict[str, Element]) -> dict[str, TextureMap]:
        maps: dict[str, TextureMap] = {}
        for slot, info in infos.items():
            made = self._read(partial(self._map, slot, info), None)
            if made is not None:
                maps[slot] = made
        return maps

    def _map(self, slot: str, info: Element) -> TextureMap | None:
        texture = self._root.entry("textures", info.integer("index"))
        place = self._place(texture)
        if place is None:
            return None
        key = BY_NAME[slot].gltf_strength
        strength = self._number(info, key, 1.0) if key else 1.0
        plain = ("repeat", "repeat"), "linear"
        wrap, texture_filter = self._read(partial(self._sampling, texture), plain)
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
        self, infos: dict[str, Element], material: Element, same: dict[int, int]
    ) -> tuple[dict[str, Element], UvSource]:
        """The maps that use the base color's UVs, else those of the first map, and these UVs.

        A mesh has one set of UVs: a map with others would be looked up in wrong places.
        """
        sources = {
            slot: self._read(partial(_uv_source, info, same), UvSource())
            for slot, info in infos.items()
        }
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

    Exporters that write both often leave the images to the older one, or all but an empty object.
    """
    glossy = material.extension(_GLOSSY)
    pbr = material.get("pbrMetallicRoughness")
    if glossy is None or pbr is None or pbr.value == {}:
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


def _alpha_mode(material: Element) -> str:
    mode = material.text("alphaMode", "OPAQUE").lower()
    return mode if mode in ("opaque", "mask", "blend") else material.fail("an alphaMode", mode)


def _uv_source(info: Element, same: dict[int, int]) -> UvSource:
    texcoord = info.integer("texCoord", 0)
    moved = info.extension("KHR_texture_transform")
    if moved is None:
        return UvSource(same.get(texcoord, texcoord))
    texcoord = moved.integer("texCoord", texcoord)
    return UvSource(
        same.get(texcoord, texcoord),
        moved.numbers("offset", (0.0, 0.0)),
        moved.number("rotation", 0.0),
        moved.numbers("scale", (1.0, 1.0)),
    )
