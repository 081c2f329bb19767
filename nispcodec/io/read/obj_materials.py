"""The materials of an OBJ file: MTL statements and images become metallic-roughness materials."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.core.asset import Material, Texture, TextureMap
from nispcodec.core.errors import MeshError
from nispcodec.core.slots import SLOT_TABLE
from nispcodec.io.folder import Folder, composed, ends_of, parts_of, readable
from nispcodec.io.images import TextureShelf, is_gray
from nispcodec.io.read import wavefront
from nispcodec.io.read.mtl import MapStatement, MtlMaterial, parse_mtl
from nispcodec.io.read.names import material_name

# Keyword of an image statement -> slot; of two for one slot the first in this list wins.
SLOT_OF = {keyword: slot.name for slot in SLOT_TABLE for keyword in slot.mtl_read}
# Options that move UVs, with the value that leaves them.
_MOVING = {"-s": 1.0, "-o": 0.0}
# Options that change the image's values.
_CHANGING = {"-boost", "-cc", "-imfchan", "-mm"}
# Words that one file name is looked for in, where a statement names several files.
MOST_WORDS = 8
# Words of one statement that may be names of files.
MOST_FILES = 64
# Names that one warning lists.
MOST_SHOWN = 8


@dataclass(frozen=True)
class Placement:
    """Where a map lies on the UVs of a file: it is looked up at uv * scale + offset.

    As Blender reads `-s` and `-o`, and as it writes the same scene to glTF.
    """

    scale: tuple[float, float] = (1.0, 1.0)
    offset: tuple[float, float] = (0.0, 0.0)

    def apply(self, uvs: Float64Array) -> Float64Array:
        """UVs (n, 2) of the file -> those looked up; NaN or infinity where they overflow."""
        with np.errstate(over="ignore", invalid="ignore"):
            placed: Float64Array = uvs * self.scale + self.offset
        return placed


class MaterialReader:
    """Turns material names into materials with the MTL files and images of one folder.

    What cannot be kept of a material is said in `warnings`.
    """

    def __init__(self, folder: Folder, warnings: list[str]) -> None:
        self._folder = folder
        self._warnings = warnings
        self._shelf = TextureShelf(warnings)
        self._libraries: set[Path] = set()
        self._lost = False
        self._known: dict[str, MtlMaterial] = {}
        self._commented: dict[str, set[str]] = {}
        self._composed: dict[str, str] = {}
        self._folders: dict[str, Folder] = {}
        self._placements: dict[str, Placement] = {}
        # Files that were not found at their very path -> the path that each was taken for first.
        self._stand_ins: dict[Path, list[str]] = {}

    @property
    def textures(self) -> Sequence[Texture]:
        """The images that the materials made so far use, each once."""
        return self._shelf.textures

    def open_library(self, reference: str, place: str) -> None:
        """Read the MTL file of an `mtllib` statement, which may name several.

        `place` is that of the statement, for warnings.
        """
        for path in self._library_paths(reference, place):
            if path in self._libraries:
                continue
            self._libraries.add(path)
            try:
                found = parse_mtl(self._folder.read(path), path.name, self._warnings)
            except MeshError as why:
                self._warnings.append(f"{place}: {why}: left out")
                continue
            self._known.update(found)
            self._folders.update(dict.fromkeys(found, self._folder.beside(path)))
            self._composed.update((composed(name), name) for name in found)
            for name in found:
                for short in wavefront.without_comments(name)[1:]:
                    self._commented.setdefault(short, set()).add(name)

    def _library_paths(self, reference: str, place: str) -> list[Path]:
        """The files that a statement names: one, or several between spaces, with spaces in them."""
        texts = wavefront.without_comments(reference)
        whole = next((path for path in map(self._folder.find, texts) if path), None)
        if whole is not None:
            return [whole]
        words, found, missing = texts[-1].split()[:MOST_FILES], list[Path](), list[str]()
        while words:
            count, path = self._longest_found(words[:MOST_WORDS])
            if path is None:
                missing.append(words[0])
            else:
                found.append(path)
            del words[:count]
        if missing or not texts[0]:
            self._lost = True
            self._warnings.append(f"{place}: material file {' '.join(missing)!r} not found")
        return found

    def _longest_found(self, words: Sequence[str]) -> tuple[int, Path | None]:
        """How many of the words make the longest name of a file, and the file; or 1 and None."""
        for count in range(len(words), 0, -1):
            path = self._folder.find(" ".join(words[:count]))
            if path is not None:
                return count, path
        return 1, None

    def resolved(self, name: str) -> str:
        """The name by which a material file holds the material that an OBJ calls `name`.

        `name` itself where none does. What follows a "#" counts as a comment where it has to.
        """
        for candidate in wavefront.without_comments(name):
            for known in (candidate, self._composed.get(composed(candidate), "")):
                if known in self._known:
                    return known
        alike = self._commented.get(name, ())
        return next(iter(alike)) if name and len(alike) == 1 else name

    def materials(self, names: Sequence[str]) -> tuple[Material, ...]:
        """One material for each name, in order; at least one."""
        self._warn_of_unknown([repr(name) for name in names if name and name not in self._known])
        return tuple(self._material(name) for name in names) or (Material(),)

    def placement(self, name: str) -> Placement:
        """Where the maps of a material that `materials` has made lie."""
        return self._placements.get(name, Placement())

    def _warn_of_unknown(self, missing: Sequence[str]) -> None:
        # A file that was not found has its warning already.
        if not missing or (self._lost and not self._libraries):
            return
        are = "material {} is" if len(missing) == 1 else "materials {} are"
        shown = ", ".join(missing[:MOST_SHOWN]) + (", ..." if missing[MOST_SHOWN:] else "")
        self._warnings.append(f"{are.format(shown)} in no material file")

    def _material(self, name: str) -> Material:
        if name not in self._known:
            return Material(name=material_name(name, self._warnings) or "material")
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
            name=material_name(found.name, self._warnings),
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
        placements: dict[str, Placement] = {}
        folder = self._folders[found.name]
        for keyword, slot in SLOT_OF.items():
            statement = found.maps.get(keyword)
            if statement is None or statement.reference == taken.get(slot):
                continue
            if slot in maps:
                self._warn(statement, f"{keyword} gives way to {taken[slot]!r}")
                continue
            made = self._map(keyword, statement, folder)
            if made is not None:
                maps[slot], taken[slot] = made, statement.reference
                placements[slot] = _placement(statement)
        self._place(found, placements)
        self._warn_of_others(found)
        return maps

    def _place(self, found: MtlMaterial, placements: dict[str, Placement]) -> None:
        """Take that of the base color, else of the first map: a mesh has one set of UVs."""
        different = set(placements.values())
        if different:
            self._placements[found.name] = next(iter(placements.values()))
        if len(different) > 1:
            self._warnings.append(
                f"material {found.name!r}: -s and -o of its maps differ; "
                f"those of {next(iter(placements))} are taken for all"
            )

    def _map(self, keyword: str, statement: MapStatement, folder: Folder) -> TextureMap | None:
        path = self._image(statement, folder)
        if path is None:
            self._warn(statement, "image not found")
            return None
        try:
            data = folder.read(path)
        except MeshError as why:
            self._warn(statement, f"{why}: left out")
            return None
        if "bump" in keyword and is_gray(data):
            self._warn(statement, "a gray height map, not a normal map: left out")
            return None
        self._warn_of_options(statement)
        texture = self._shelf.add(readable(path.name), data, readable(str(path)))
        if texture is None:
            return None
        clamp = [value.lower() for value in statement.options.get("-clamp", [])]
        wrap = "clamp" if clamp == ["on"] else "repeat"
        return TextureMap(texture, (wrap, wrap), strength=_strength(statement))

    def _image(self, statement: MapStatement, folder: Folder) -> Path | None:
        """The image of a statement: beside its material file, else beside the OBJ.

        Only where neither has it, at the longest end of its path that either has.
        """
        names = statement.references
        path = self._beside_either(names, folder)
        if path is not None:
            return path
        path = self._beside_either([end for name in names for end in ends_of(name)], folder)
        if path is not None:
            self._warn_of_stand_in(statement, path)
        return path

    def _beside_either(self, names: Sequence[str], folder: Folder) -> Path | None:
        places = (place.exact(name) for name in names for place in (folder, self._folder))
        return next((path for path in places if path is not None), None)

    def _warn_of_stand_in(self, statement: MapStatement, path: Path) -> None:
        """Where one file is taken for two paths of which neither may be the other's end."""
        wanted = parts_of(statement.reference.casefold())
        known = self._stand_ins.setdefault(path, wanted)
        shared = min(len(known), len(wanted))
        if known[-shared:] != wanted[-shared:]:
            others = repr("/".join(known))
            self._warn(statement, f"not found, {path.name} is taken for it as for {others}")

    def _warn_of_options(self, statement: MapStatement) -> None:
        for option, values in statement.options.items():
            if option == "-t" and any(map(float, values)):
                self._warn(statement, "-t is not applied: texture coordinates stay")
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


def _placement(statement: MapStatement) -> Placement:
    """The -s and -o of a statement."""
    (scale_u, scale_v), (u, v) = (_pair(statement, *each) for each in _MOVING.items())
    return Placement((scale_u, scale_v), (u, v))


def _pair(statement: MapStatement, option: str, neutral: float) -> tuple[float, float]:
    """Two values of an option: a missing one is neutral."""
    numbers = [*map(float, statement.options.get(option, ())), neutral, neutral]
    return numbers[0], numbers[1]


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
    return float(statement.options.get("-bm", ["1"])[0])
