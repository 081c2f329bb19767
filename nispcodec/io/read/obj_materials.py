"""The materials of an OBJ file: MTL statements and images become metallic-roughness materials."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

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


class Meant(NamedTuple):
    """A material that an OBJ means: its name, and the material file that holds it, if any does."""

    name: str
    library: Path | None


@dataclass(frozen=True)
class _Library:
    """One material file: its folder, its materials, and where `mtllib` statements name it.

    `named` has the numbers of the statements, and the file's place in each.
    """

    folder: Folder
    materials: dict[str, MtlMaterial]
    named: list[tuple[int, int]] = field(default_factory=list)

    def nearness(self, statements: int) -> tuple[bool, int, int]:
        """How much this file is meant after so many statements: by the last of them the most.

        Of the files of one statement it is the first.
        """
        before = bisect_left(self.named, (statements,))
        if before:
            statement, place = self.named[before - 1]
            return True, statement, -place
        statement, place = self.named[0]
        return False, -statement, -place


class MaterialReader:
    """Turns material names into materials with the MTL files and images of one folder.

    What cannot be kept of a material is said in `warnings`.
    """

    def __init__(self, folder: Folder, warnings: list[str]) -> None:
        self._folder = folder
        self._warnings = warnings
        self._shelf = TextureShelf(warnings)
        self._libraries: dict[Path, _Library] = {}
        self._statements = 0
        self._lost = False
        self._holders: dict[str, list[Path]] = {}
        self._commented: dict[str, set[str]] = {}
        self._composed: dict[str, str] = {}
        self._placements: dict[Meant, Placement] = {}
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
        for number, path in enumerate(dict.fromkeys(self._library_paths(reference, place))):
            if path not in self._libraries:
                materials = self._read_library(path, place)
                self._libraries[path] = _Library(self._folder.beside(path), materials)
                self._note_names(materials, path)
            self._libraries[path].named.append((self._statements, number))
        self._statements += 1

    def _read_library(self, path: Path, place: str) -> dict[str, MtlMaterial]:
        try:
            return parse_mtl(self._folder.read(path), readable(path.name), self._warnings)
        except MeshError as why:
            self._warnings.append(f"{place}: {why}: left out")
            return {}

    def _note_names(self, names: Iterable[str], path: Path) -> None:
        for name in names:
            self._holders.setdefault(name, []).append(path)
            self._composed[composed(name)] = name
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

    def resolved(self, name: str, statements: int) -> Meant:
        """The material that an OBJ calls `name` after so many `mtllib` statements.

        Of several files that hold it, that of the last of these statements is meant; of those that
        hold the same, the first.
        """
        held = self._held_name(name)
        paths = self._holders.get(held, ())
        if not paths:
            return Meant(held, None)
        near = max(paths, key=lambda path: self._libraries[path].nearness(statements))
        return Meant(held, next(path for path in paths if not self._differ(held, path, near)))

    def _held_name(self, name: str) -> str:
        """The name by which a material file holds the material that an OBJ calls `name`.

        `name` itself where none does. What follows a "#" counts as a comment where it has to.
        """
        for candidate in wavefront.without_comments(name):
            for known in (candidate, self._composed.get(composed(candidate), "")):
                if known in self._holders:
                    return known
        alike = self._commented.get(name, ())
        return next(iter(alike)) if name and len(alike) == 1 else name

    def materials(self, meant: Sequence[Meant]) -> tuple[Material, ...]:
        """One material for each that is meant, in order; at least one."""
        self._warn_of_unknown([repr(name) for name, library in meant if name and library is None])
        self._warn_of_others_of_a_name(meant)
        return tuple(map(self._material, meant)) or (Material(),)

    def placement(self, meant: Meant) -> Placement:
        """Where the maps of a material that `materials` has made lie."""
        return self._placements.get(meant, Placement())

    def _warn_of_others_of_a_name(self, meant: Sequence[Meant]) -> None:
        """Where files that hold a material do not agree: which of them counts."""
        used: dict[str, list[Path]] = {}
        for name, library in meant:
            if library is not None:
                used.setdefault(name, []).append(library)
        for name, libraries in used.items():
            paths = self._holders[name]
            if any(self._differ(name, paths[0], other) for other in paths[1:]):
                held = " and in ".join(map(self._shown, paths[:MOST_SHOWN]))
                counts = f"that of {self._shown(libraries[0])} counts"
                if len(libraries) > 1:
                    counts = "of these the one whose mtllib comes last before a face counts"
                self._warnings.append(f"material {name!r} is not the same in {held}: {counts}")

    def _differ(self, name: str, first: Path, second: Path) -> bool:
        one, other = self._libraries[first], self._libraries[second]
        made, again = one.materials[name], other.materials[name]
        return made != again or (bool(made.maps) and one.folder != other.folder)

    def _shown(self, path: Path) -> str:
        """A file's path from the OBJ, for messages."""
        inside = path.is_relative_to(self._folder.path)
        return readable(str(path.relative_to(self._folder.path) if inside else path))

    def _warn_of_unknown(self, missing: Sequence[str]) -> None:
        # A file that was not found has its warning already.
        if not missing or (self._lost and not self._libraries):
            return
        are = "material {} is" if len(missing) == 1 else "materials {} are"
        shown = ", ".join(missing[:MOST_SHOWN]) + (", ..." if missing[MOST_SHOWN:] else "")
        self._warnings.append(f"{are.format(shown)} in no material file")

    def _material(self, meant: Meant) -> Material:
        if meant.library is None:
            return Material(name=material_name(meant.name, self._warnings) or "material")
        library = self._libraries[meant.library]
        return self._finished(meant, library.materials[meant.name], library.folder)

    def _finished(self, meant: Meant, found: MtlMaterial, folder: Folder) -> Material:
        alpha = _alpha(found.values)
        if alpha == 0:
            self._warnings.append(f"material {found.name!r}: invisible, taken as opaque")
            alpha = 1.0
        maps = self._maps(meant, found, folder)
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

    def _maps(self, meant: Meant, found: MtlMaterial, folder: Folder) -> dict[str, TextureMap]:
        maps: dict[str, TextureMap] = {}
        taken: dict[str, str] = {}
        placements: dict[str, Placement] = {}
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
        self._place(meant, placements)
        self._warn_of_others(found)
        return maps

    def _place(self, meant: Meant, placements: dict[str, Placement]) -> None:
        """Take that of the base color, else of the first map: a mesh has one set of UVs."""
        different = set(placements.values())
        if different:
            self._placements[meant] = next(iter(placements.values()))
        if len(different) > 1:
            self._warnings.append(
                f"material {meant.name!r}: -s and -o of its maps differ; "
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
            self._warn(
                statement, f"not found, {readable(path.name)} is taken for it as for {others}"
            )

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
