"""`nisp decode`: a `.nisp` file to a textured mesh."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .choices import LibraryChoice, compressions, mesh_suffixes
from .errors import warn
from .extras import expect_installed
from .grid import SUFFIX, expect_fitting, write_grid
from .lines import duration
from .outputs import OutputFile, listed, output_option, refuse_overwriting
from .progress import progress_options, shown
from .ranges import Real, Whole
from .report import print_json, print_written
from .sources import Source, model_argument, parsed
from .subcommand import force_option, json_option, subcommand

if TYPE_CHECKING:
    from nispcodec.core.asset import TexturedMesh
    from nispcodec.core.progress import Listener
    from nispcodec.model import NispModel

REBAKE_FACES = 20_000
"""Making an atlas takes minutes for the hundreds of thousands of triangles of a plain decode."""
FEWER = (
    "  fewer faces: --faces 5000, or --target-error 1e-3 (mean distance, in radii); "
    "all of a grid: --resolution 256"
)


@subcommand("decode", "Write a .nisp file as a textured mesh.")
@model_argument
@output_option(OutputFile(lambda: (*mesh_suffixes(), SUFFIX)))
@click.option(
    "--mesh", "kind", flag_value="mesh", default="mesh", help="A textured mesh (default)."
)
@click.option(
    "--resolution", type=Whole(8, 2048), help="All triangles of a grid of so many cells a side."
)
@click.option("--faces", type=Whole(4), help="Simplify to at most this many triangles.")
@click.option(
    "--target-error",
    "error",
    type=Real(0, min_open=True),
    metavar="ERROR",
    help="As few triangles as keep the mean distance to the field's surface below this, in radii.",
)
@click.option(
    "--lods",
    type=Whole(1, 8),
    default=1,
    metavar="LEVELS",
    help="So many levels of detail, each with a quarter of the triangles: out.glb, out.lod1.glb.",
)
@click.option("--colors", is_flag=True, help="Vertex colors instead of textures.")
@click.option(
    "--rebake",
    type=Whole(16, 8192),
    is_flag=False,
    flag_value=1024,
    metavar="[SIZE]",
    help=f"One new atlas, textures 1024 texels wide; {REBAKE_FACES:,} faces unless told.",
)
@click.option(
    "--grid",
    type=Whole(16, 1024),
    metavar="SAMPLES",
    help="Signed distances on a grid in place of a mesh, so many along the longest side: an .npz.",
)
@click.option(
    "--compress",
    type=LibraryChoice(compressions),
    help="A smaller GLB or glTF, images as they are; draco and meshopt take the extra gltf.",
)
@click.option("--keep-spurious", is_flag=True, help="Keep what is recognized as noise.")
@force_option
@progress_options
@json_option
def command(
    model: Source,
    output: Path,
    kind: str,
    lods: int,
    colors: bool,
    rebake: int | None,
    grid: int | None,
    compress: str | None,
    force: bool,
    progress: str,
    quiet: bool,
    as_json: bool,
    **how: Any,
) -> None:
    """Write the surface of MODEL (.nisp, or - for standard input) as a textured mesh.

    It is in the units of the original. Of a field, as many triangles are written
    as keep it within a part of its own error, at most 60,000, from a grid of 256
    to 512 cells a side. A glTF gets its buffer and images
    beside it, an OBJ its MTL and images, a PLY its images. Levels share their images.

    \b
    Example: nisp decode model.nisp --mesh -o out.glb
             nisp decode model.nisp --compress meshopt -o small.glb
             nisp decode model.nisp --lods 3 -o model.glb
             nisp decode model.nisp --grid 128 -o field.npz
    """
    from nispcodec.io.save import expect_compressible, level_paths
    from nispcodec.model import NispModel

    expect_compressible(output, compress)
    for other, given in (("--colors", colors), ("--lods", lods > 1)):
        if rebake and given:
            raise click.UsageError(f"{other} and --rebake: expected one of them, found both")
    if rebake:
        expect_installed("xatlas", "scipy")
    expect_fitting(output, grid)
    started = time.monotonic()
    loaded = NispModel(parsed(model.read(), model))
    if grid is not None:
        with shown("decode", progress, quiet) as listen:
            write_grid(loaded, output, grid, how["resolution"], force, as_json, listen)
        return
    paths = level_paths(output, lods)
    refuse_overwriting(_planned(loaded, paths, colors, bool(rebake)), force)
    with shown("decode", progress, quiet) as listen:
        levels = _written(loaded, paths, colors, rebake, compress, how, listen)
    simple = bool(loaded.document.field) and how["faces"] is None and how["error"] is None
    _told(levels, colors, time.monotonic() - started, simple, as_json)


@dataclass(frozen=True)
class Level:
    """A mesh that was written, and its files, that of the mesh last."""

    mesh: TexturedMesh
    files: list[Path]

    def report(self) -> dict[str, Any]:
        """What is said of it."""
        counts = {"faces": len(self.mesh.faces), "vertices": len(self.mesh.positions)}
        return {"file": str(self.files[-1]), **counts, "files": listed(self.files)}


def _told(levels: list[Level], colors: bool, seconds: float, simple: bool, as_json: bool) -> None:
    """Print what was lost, and what was written; `simple`: there might be fewer faces."""
    from nispcodec.core.counted import counted
    from nispcodec.io.save import losses

    first = levels[0].mesh
    warnings = [*first.warnings, *(() if colors else losses(first, levels[0].files[-1]))]
    finest, *coarser = [each.report() for each in levels]
    warnings += _stuck([finest, *coarser])
    warn(warnings)
    if as_json:
        more = {"levels": coarser} if coarser else {}
        print_json({**finest, "warnings": warnings, "seconds": round(seconds, 1), **more})
        return
    for each, report in zip(levels, (finest, *coarser), strict=True):
        took = f" in {duration(seconds)}" if report is finest else ""
        click.echo(f"{report['file']}: {counted(report['faces'], 'face')}{took}")
        print_written(each.files, "  ")
    if simple:
        click.echo(FEWER)


def _stuck(reports: list[dict[str, Any]]) -> list[str]:
    """A sentence where a level has as many triangles as the one before; [] where none has."""
    alike = [(more, less) for more, less in pairwise(reports) if less["faces"] >= more["faces"]]
    return [
        f"{less['file']}: has no fewer triangles than {Path(more['file']).name}, as they are the "
        "fewest that its bodies take: ask for fewer --lods"
        for more, less in alike[:1]
    ]


def _planned(model: NispModel, paths: list[Path], colors: bool, rebake: bool) -> list[Path]:
    """Every file that will be written."""
    from nispcodec.io.save import mesh_paths

    document = model.document
    materials, textures = document.materials, document.textures
    if rebake:
        materials, textures = _rebaked_appearance(model)
    first, *coarser = paths
    files = mesh_paths(first, materials, textures, colors)
    for path in coarser:
        files += mesh_paths(path, materials, textures, colors, finer=first)
    return files


def _rebaked_appearance(model: NispModel) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
    """A material and textures, still empty, named as rebaking names them."""
    from nispcodec.bake.rebake import baked_names
    from nispcodec.core.asset import Material, Texture, TextureMap

    names = baked_names(model)
    maps = {slot: TextureMap(number) for number, slot in enumerate(names)}
    textures = tuple(Texture(name, b"", "image/png") for name in names.values())
    return (Material(maps=maps),), textures


def _written(
    model: NispModel,
    paths: list[Path],
    colors: bool,
    rebake: int | None,
    compress: str | None,
    how: dict[str, Any],
    listen: Listener,
) -> list[Level]:
    """The meshes, in as many levels as there are paths, and the files that they were written to."""
    from nispcodec.core.progress import Progress
    from nispcodec.io.save import write_mesh

    note = expected(model, how["resolution"])
    listen(Progress(stage="surface", note=note, overall=0.0))
    if rebake and how["faces"] is None and how["error"] is None:
        how = {**how, "faces": REBAKE_FACES}
    meshes = model.to_lods(len(paths), **how)
    if "name" not in model.document.info:
        meshes = [replace(mesh, name=paths[0].stem) for mesh in meshes]
    if rebake:
        listen(Progress(stage="atlas", overall=0.5))
        meshes = [baked(model, mesh, rebake) for mesh in meshes]
    listen(Progress(stage="files", overall=0.9))
    levels: list[Level] = []
    for mesh, path in zip(meshes, paths, strict=True):
        seen = model.color(mesh.positions) if colors else None
        finer = paths[0] if levels else None
        levels.append(Level(mesh, write_mesh(mesh, path, seen, compress, finer)))
    return levels


def expected(model: NispModel, resolution: int | None) -> str:
    """What a fine grid will take, in words; "" for one that nobody has to wait for.

    Raises NispError where it is more memory than there is.
    """
    from nispcodec.core.errors import NispError
    from nispcodec.extract.config import ResolutionConfig
    from nispcodec.extract.meshing import expected_faces

    config, field = ResolutionConfig(), model.document.field
    if field is None or resolution is None or resolution <= config.most:
        return ""
    faces = expected_faces(field.sdf, resolution)
    needed, free = faces * config.bytes_per_face, free_memory()
    said = f"about {faces:,} faces and {needed / 1e9:.1f} GB of memory"
    if free is not None and needed > free:
        raise NispError(
            f"--resolution {resolution}: expected {said}, found {free / 1e9:.1f} GB free: "
            f"--resolution {int(resolution * (free / needed) ** 0.5)} fits"
        )
    return f"resolution {resolution}: {said}"


def free_memory() -> int | None:
    """Bytes of memory that nobody needs, None where the system does not say."""
    said = Path("/proc/meminfo")
    if not said.exists():
        return None
    lines = dict(line.split(":", 1) for line in said.read_text().splitlines())
    return int(lines["MemAvailable"].split()[0]) * 1024


def baked(model: NispModel, mesh: TexturedMesh, size: int) -> TexturedMesh:
    """The mesh with an atlas and textures of its own."""
    from nispcodec.bake.rebake import rebaked
    from nispcodec.bake.unwrap import unwrap, with_collapsed_named

    from .unwrapping import apart

    # The warning of textures that no longer fit is none here: new ones are made.
    atlas = with_collapsed_named(replace(apart(unwrap, mesh), warnings=mesh.warnings))
    return replace(rebaked(model, atlas, size), warnings=atlas.warnings)
