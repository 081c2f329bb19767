"""The materials of an OBJ file: MTL statements and images become metallic-roughness materials."""

from __future__ import annotations

from collections.abc import Sequence

from nispcodec.core.asset import Material, Texture, TextureMap
from nispcodec.core.errors import MeshError
from nispcodec.core.slots import SLOT_TABLE
from nispcodec.io.folder import Folder
from nispcodec.io.images import TextureShelf, is_gray
from nispcodec.io.read.mtl import MapStatement, MtlMaterial, is_number, parse_mtl

# Keyword of an image statement -> slot; of two for one slot the first in this list wins.
SLOT_OF = {keyword: slot.name for slot in SLOT_TABLE for keyword in slot.mtl_read}
# Options that move UVs, and that change the image's values.
_MOVING = {"-o", "-s", "-t"}
_CHANGING = {"-boost", "-cc", "-imfchan", "-mm"}


class MaterialReader:
    """Turns material names into materials with the MTL files and images of one folder.

    What cannot be kept of a material is said in `warnings`.
    """

    def __init__(self, folder: Folder, warnings: list[str]) -> None:
        self._folder = folder
        self._warnings = warnings
        self._shelf = TextureShelf(warnings)
        self._known: dict[str, MtlMaterial] = {}
        self._libraries = 0

    @property
    def textures(self) -> Sequence[Texture]:
        """The images that the materials made so far use, each once."""
        return self._shelf.textures

    def open_library(self, reference: str, place: str) -> None:
        """Read the MTL file of an `mtllib` statement, which may name several.

        `place` is that of the statement, for warnings. Raises MeshError for a malformed MTL file.
        """
        whole = self._folder.find(reference)
        names = [reference] if whole else reference.split()
        for name in names:
            path = self._folder.find(name)
            if path is None:
                self._warnings.append(f"{place}: material file {name!r} not found")
                continue
            self._libraries += 1
            self._known.update(parse_mtl(self._folder.read(path), path.name))

    def materials(self, names: Sequence[str]) -> tuple[Material, ...]:
        """One material for each name, in order; at least one.

        Raises MeshError for an image that cannot be read and for a malformed option.
        """
        return tuple(self._material(name) for name in names) or (Material(),)

    def _material(self, name: str) -> Material:
        if name not in self._known:
            if name and self._libraries:
                self._warnings.append(f"material {name!r} is in no material file")
            return Material(name=name or "material")
        return self._finished(self._known[name])

    def _finished(self, found: MtlMaterial) -> Material:
        alpha = _alpha(found.values)
        if alpha == 0:
            self._warnings.append(f"material {found.name!r}: invisible, taken as opaque")
            alpha = 1.0
        maps = self._maps(found)
        red, green, blue = _color(found.values.get("kd"), (1.0, 1.0, 1.0))
        if "base_color" in maps and (red, green, blue) == (0.0, 0.0, 0.0):
            # Exporters that mean the image alone write black here.
            self._warnings.append(f"material {found.name!r}: black Kd under map_Kd taken as white")
            red, green, blue = 1.0, 1.0, 1.0
        glow = _color(found.values.get("ke"), (0.0, 0.0, 0.0))
        if "emissive" in maps and glow == (0.0, 0.0, 0.0):
            glow = (1.0, 1.0, 1.0)
        return Material(
            name=found.name,
            base_color=(red, green, blue, alpha),
            metallic=_unit(found.values.get("pm", [0.0])[0]),
            roughness=_unit(found.values.get("pr", [1.0])[0]),
            emissive=glow,
            alpha_mode="blend" if alpha < 1 else "opaque",
            maps=maps,
        )

    def _maps(self, found: MtlMaterial) -> dict[str, TextureMap]:
        maps: dict[str, TextureMap] = {}
        taken: dict[str, str] = {}
        for keyword, slot in SLOT_OF.items():
            statement = found.maps.get(keyword)
            if statement is None or statement.reference == taken.get(slot):
                continue
            if slot in maps:
                self._warn(statement, f"{keyword} gives way to {taken[slot]!r}")
                continue
            made = self._map(keyword, statement)
            if made is not None:
                maps[slot], taken[slot] = made, statement.reference
        self._warn_of_others(found)
        return maps

    def _map(self, keyword: str, statement: MapStatement) -> TextureMap | None:
        path = self._folder.find(statement.reference)
        if path is None:
            self._warn(statement, "image not found")
            return None
        data = self._folder.read(path)
        if "bump" in keyword and is_gray(data, str(path)):
            self._warn(statement, "a gray height map, not a normal map: left out")
            return None
        self._warn_of_options(statement)
        texture = self._shelf.add(path.name, data, str(path))
        if texture is None:
            return None
        clamp = [value.lower() for value in statement.options.get("-clamp", [])]
        wrap = "clamp" if clamp == ["on"] else "repeat"
        return TextureMap(texture, (wrap, wrap), strength=_strength(statement))

    def _warn_of_options(self, statement: MapStatement) -> None:
        for option, values in statement.options.items():
            if option in _MOVING and not _stays(option, values):
                self._warn(statement, f"{option} is not applied: texture coordinates stay")
            elif option in _CHANGING:
                self._warn(statement, f"{option} is not applied: the image stays")

    def _warn_of_others(self, found: MtlMaterial) -> None:
        base = found.maps["map_kd"].reference if "map_kd" in found.maps else None
        for keyword, statement in found.maps.items():
            # Exporters often repeat the base color as the ambient one.
            repeated = keyword == "map_ka" and statement.reference == base
            if keyword not in SLOT_OF and not repeated:
                self._warn(statement, f"{keyword} is not supported")

    def _warn(self, statement: MapStatement, what: str) -> None:
        self._warnings.append(f"{statement.place}: {statement.reference!r}: {what}")


def _stays(option: str, values: Sequence[str]) -> bool:
    """Whether an option moves UVs by nothing; some exporters always write it."""
    neutral = 1.0 if option == "-s" else 0.0
    return all(is_number(value) and float(value) == neutral for value in values)


def _alpha(values: dict[str, list[float]]) -> float:
    transparency = values.get("tr", [0.0])[0]
    return _unit(values.get("d", [1.0 - transparency])[0])


def _color(
    values: list[float] | None, default: tuple[float, float, float]
) -> tuple[float, float, float]:
    if not values:
        return default
    red, green, blue = values[:3] if len(values) > 2 else (values[0],) * 3
    return _unit(red), _unit(green), _unit(blue)


def _unit(value: float) -> float:
    return min(max(value, 0.0), 1.0)


def _strength(statement: MapStatement) -> float:
    values = statement.options.get("-bm", ["1"])
    if not values or not is_number(values[0]):
        raise MeshError(f"{statement.place}: expected a number after -bm, found {values!r}")
    return float(values[0])
