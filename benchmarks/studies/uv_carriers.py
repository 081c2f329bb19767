"""Charts and UVs of a field: in networks, or on a coarse mesh that carries them to its surface.

    nisp encode NAME.obj -o build/fields/NAME.nisp --geometry field
    python -m benchmarks.studies.uv_carriers --models build/fields --assets ../shared/assets

A carrier is a mesh part without creases and sheets, simplified and coded as all are. A point of the
field's decoded surface has chart and UV of the carrier's closest point. Points of that surface and
of the original are paired as `nispcodec.metrics` pairs them, and only what the former look like
differs: for networks it is told by the decoded mesh, for carriers by the carrier itself, so that
their seams are not even blurred by an extraction.

Carriers are made in three ways. `plain`: as the encoder makes mesh parts. `projected`: readers move
the vertices onto the field's surface, and UVs are fitted to there, so that positions may be coarse.
`for UVs`: the same, but UVs weigh ten times as much when edges are collapsed, and seams four times
as much when vertices are moved. The latter two hold no copies.

Bytes at equal error are read off between two carriers that are no worse than others in both. The
rival is networks, and the fewest bytes of triangles that are as near as the field, with no larger
UV error.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from pathlib import Path

import click
import numpy as np

import nispcodec
from benchmarks.measuring.field_of import field_of
from benchmarks.measuring.model_records import measured, models_options
from benchmarks.measuring.result_file import Record
from nispcodec.core.arrays import Float64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import Document
from nispcodec.core.mesh_part import MeshPart
from nispcodec.encode.mesh_form import coded_bytes
from nispcodec.extract.meshing import textured_mesh
from nispcodec.format import inspect, unpack
from nispcodec.format.constants import NETS, TXTR
from nispcodec.geometry.analysis import analyze
from nispcodec.geometry.shown import shown
from nispcodec.infer.field import FieldQueries
from nispcodec.metrics.color import color_psnr
from nispcodec.metrics.compare import Reference
from nispcodec.metrics.geometry import Matches
from nispcodec.metrics.surface import Surface
from nispcodec.metrics.uv import uv_errors
from nispcodec.simplify.config import CollapseConfig, CopiesConfig, FitConfig, LadderConfig
from nispcodec.simplify.errors import Counted, mesh_of
from nispcodec.simplify.ladder import Simplifier
from nispcodec.simplify.quantize import Grid
from nispcodec.simplify.scene import scene
from nispcodec.simplify.search import best_for
from nispcodec.simplify.triangles import Triangles, distinct_corners
from nispcodec.simplify.uv_fit import fitted_uvs

RESULTS = Path("benchmarks/results/uv_carriers.json")
SAMPLES = 20_000
ASTRAY = 5e-3
"""Share of the atlas; UVs that are off by more are those of another chart, as a rule."""
GROWTH = 2.0
FIRST, MOST = 0.125, 3.0
"""The first carrier has so many faces for each byte of the networks for charts and UVs; one of MOST
times their bytes is the last."""
COARSER = (0, 2)
"""Bits less of positions than errors before rounding suggest."""
NEAR = 0.05
"""Vertices that a projection would move farther stay: there is another surface (radii)."""
NO_COPIES = CopiesConfig(fewest=1 << 30)
FOR_UVS = LadderConfig(
    collapse=CollapseConfig(uv_weight=100.0), fit=FitConfig(seam_weight=2.0), copies=NO_COPIES
)
WAYS = {
    "plain": (LadderConfig(), False),
    "projected": (LadderConfig(copies=NO_COPIES), True),
    "for UVs": (FOR_UVS, True),
}
"""How edges are collapsed and vertices fitted, and whether readers move vertices onto the field."""


@dataclass(frozen=True)
class Task:
    """An asset and the path of its field."""

    mesh: TexturedMesh
    path: Path

    @cached_property
    def reference(self) -> Reference:
        """SAMPLES points of the original."""
        return Reference.of(self.mesh, samples=SAMPLES, seed=0)

    @cached_property
    def document(self) -> Document:
        """The file of the field."""
        return unpack(self.path.read_bytes())

    @cached_property
    def sizes(self) -> dict[str, int]:
        """Bytes of each network, and of all but images as `geometry_uv`."""
        sections = inspect(self.path.read_bytes())
        total = sum(each.stored_length for each in sections if each.code != TXTR)
        networks = next(each.parts for each in sections if each.code == NETS)
        return {**networks, "geometry_uv": total}

    @property
    def looks(self) -> int:
        """Bytes of the chart and UV networks."""
        return self.sizes.get("chart", 0) + self.sizes["uv"]

    @cached_property
    def decoded(self) -> Surface:
        """What the field decodes to."""
        return Surface.of(textured_mesh(self.document)[0], self.reference.frame)

    @cached_property
    def pairs(self) -> list[Matches]:
        """Points of the original and of the decoded surface."""
        return pairs_of(self.reference, self.decoded)

    @cached_property
    def distance(self) -> float:
        """Mean distance of the field's surface, normalized frame."""
        return max(float(each.distances.mean()) for each in self.pairs)

    @cached_property
    def networks(self) -> Record:
        """Errors of the networks."""
        return self.errors(self.decoded, self.pairs)

    def simplifier(self, ladder: LadderConfig, *, bare: bool) -> Simplifier:
        """Of the faces that can be seen; bare: without creases and sheets."""
        analysis = analyze(self.mesh, 0)
        found = shown(analysis)
        triangles = Triangles.of(found.mesh, analysis.frame, None, found.sheet)
        if bare:
            none = np.zeros(len(triangles), np.bool_)
            triangles = replace(triangles, creases=None, sheet=none)
        counted = Counted(found.faces, found.inner).only(distinct_corners(found.mesh))
        return Simplifier.of(triangles, coded_bytes, ladder, 0, counted)

    def surface(self, parts: tuple[MeshPart, ...], *, moved: bool = False) -> Surface:
        """Parts in the asset's looks; moved: their vertices onto the field's surface."""
        mesh = scene([(mesh_of(part), part.placements) for part in parts])
        mesh = replace(mesh, materials=self.mesh.materials, textures=self.mesh.textures)
        return Surface(mesh, self.projected(mesh.positions) if moved else mesh.positions)

    def carried(self, carrier: Surface) -> Record:
        """Errors of a carrier, asked at the decoded surface."""
        pairs = [
            Matches(each.original, carrier.closest(each.decoded.positions)) for each in self.pairs
        ]
        return self.errors(carrier, pairs)

    def errors(self, surface: Surface, pairs: list[Matches]) -> Record:
        """UV errors, the larger of both directions; share of points astray; PSNR of colors."""
        original = self.reference.surface
        misses = [uv_errors(original, surface, each) for each in pairs]
        far = ASTRAY * float(np.linalg.norm(np.ptp(self.mesh.uvs, axis=0)))
        return {
            "uv_mean": max(float(each.mean()) for each in misses),
            "uv_median": max(float(np.median(each)) for each in misses),
            "uv_p95": max(float(np.percentile(each, 95)) for each in misses),
            "astray": max(float((each > far).mean()) for each in misses),
            "psnr": color_psnr(original, surface, pairs),
        }

    def projected(self, positions: Float64Array) -> Float64Array:
        """Positions (n, 3) moved onto the field's surface, as readers would."""
        queries = FieldQueries(field_of(self.document))
        moved = queries.project(positions.astype(np.float32)).astype(np.float64)
        near = np.linalg.norm(moved - positions, axis=1) <= NEAR
        return np.where(near[:, None], moved, positions)


def pairs_of(reference: Reference, decoded: Surface) -> list[Matches]:
    """Outer points of the original, and points of another surface, with their counterparts."""
    original, seen = reference.surface, reference.seen
    points = decoded.sample(reference.samples, np.random.default_rng([reference.seed, 1]))
    return [
        Matches(seen, decoded.closest(original.outlook(seen))),
        Matches(original.closest(points.positions), points),
    ]


def carriers(task: Task, way: str) -> list[Record]:
    """Carriers of more and more faces, until one is as good as the networks, or far larger."""
    ladder, moved = WAYS[way]
    simplifier = task.simplifier(ladder, bare=True)
    points: list[Record] = []
    faces, everything = FIRST * task.looks, len(simplifier.source.triangles)
    while faces < everything:
        found = list(_rung(task, simplifier, round(faces), moved))
        points += found
        least = min(each["bytes"] for each in found) / task.looks
        if least > MOST or any(_as_good(each, task.networks) for each in found):
            break
        faces *= GROWTH
    return points


def _rung(task: Task, simplifier: Simplifier, faces: int, moved: bool) -> Iterator[Record]:
    """Carriers of about so many faces, rounded more and less coarsely."""
    before = simplifier.original.errors(simplifier.copies.scene(simplifier.fitted(faces)))
    bits = simplifier.bits_for(before.distance)
    uv_bits = simplifier.uv_bits_for(max(before.uv_median / 4, task.networks["uv_median"]))
    for less in COARSER:
        parts = _rounded(task, simplifier, faces, bits - less, uv_bits, moved)
        size = coded_bytes(parts)
        yield {
            "faces": sum(len(part.faces) for part in parts),
            "bits": bits - less,
            "uv_bits": uv_bits,
            "bytes": size,
            "other_bytes": size - position_bytes(parts),
            **task.carried(task.surface(parts, moved=moved)),
        }


def _rounded(
    task: Task, simplifier: Simplifier, faces: int, bits: int, uv_bits: int, moved: bool
) -> tuple[MeshPart, ...]:
    """About so many faces as parts, UVs fitted to where readers will have the vertices."""
    triangles = simplifier.fitted(faces)
    grid, config = Grid.of(triangles.positions, bits), simplifier.config
    placed = simplifier.copies.rounded(triangles, grid, config.rounding, simplifier.seed)
    seen = replace(placed, positions=task.projected(placed.positions)) if moved else placed
    uvs = fitted_uvs(simplifier.source, seen, config.fit, simplifier.seed).uvs
    return simplifier.copies.parts(replace(placed, uvs=uvs), grid, Grid.of(uvs, uv_bits))


def position_bytes(parts: tuple[MeshPart, ...]) -> int:
    """Bytes of the positions: what is saved, without UVs, where all vertices are in one place."""
    bare = tuple(
        replace(
            part,
            uv_faces=np.full_like(part.uv_faces, -1),
            chart_has_uv=np.zeros_like(part.chart_has_uv),
        )
        for part in parts
    )
    none = tuple(replace(part, positions=np.zeros_like(part.positions)) for part in bare)
    return coded_bytes(bare) - coded_bytes(none)


def _as_good(found: Record, networks: Record) -> bool:
    return bool(found["uv_mean"] <= networks["uv_mean"] and found["psnr"] >= networks["psnr"])


def equal(points: list[Record], networks: Record, size: str = "bytes") -> Record:
    """Bytes of one way at the networks' UV error, at their PSNR, and at both; None: not reached."""
    found = {error: bytes_at(points, error, networks, size) for error in ("uv_mean", "psnr")}
    reached = [each for each in found.values() if each is not None]
    return {**found, "both": max(reached) if len(reached) == len(found) else None}


def bytes_at(points: list[Record], error: str, networks: Record, size: str) -> int | None:
    """Bytes at the networks' error, on a line between two carriers, sizes as logarithms."""
    front: list[tuple[float, float]] = []
    for point in sorted(points, key=lambda each: float(each[size])):
        off = _off(point, error)
        if not front or off < front[-1][1]:
            front.append((float(np.log(point[size])), off))
    wanted = _off(networks, error)
    for (small, worse), (large, better) in pairwise(front):
        if better <= wanted:
            share = max((worse - wanted) / (worse - better), 0.0)
            return round(float(np.exp(small + share * (large - small))))
    return None


def _off(point: Record, error: str) -> float:
    """How bad an error is; that of UVs as a logarithm."""
    return -float(point["psnr"]) if error == "psnr" else float(np.log(point[error]))


def triangles_alone(task: Task) -> Record | None:
    """The fewest bytes as near as the field, with no larger UV error, and their errors."""
    simplifier = task.simplifier(LadderConfig(), bare=False)
    best = best_for(simplifier, task.distance, task.networks["uv_mean"])
    if best is None:
        return None
    surface = task.surface(best.parts)
    errors = task.errors(surface, pairs_of(task.reference, surface))
    return {"bytes": best.size, "faces": best.faces, **errors}


def front(points: list[Record]) -> list[Record]:
    """The carriers that no other beats in bytes, UV error and PSNR together."""
    return [
        one
        for one in points
        if not any(
            other is not one and other["bytes"] <= one["bytes"] and _as_good(other, one)
            for other in points
        )
    ]


def measure(model: Path, asset: Path) -> Record:
    """Everything about one asset."""
    task = Task(nispcodec.load_mesh(asset), model)
    points = {way: carriers(task, way) for way in WAYS}
    networks, other = task.networks, "other_bytes"
    return {
        "sizes": task.sizes,
        "distance": task.distance,
        "networks": {"bytes": task.looks, **networks},
        "at_equal_error": {way: equal(each, networks) for way, each in points.items()},
        "if_positions_were_free": {
            way: equal(each, networks, other) for way, each in points.items()
        },
        "triangles": triangles_alone(task),
        "carriers": {way: front(each) for way, each in points.items()},
    }


@click.command()
@models_options(RESULTS)
def main(models: Path, assets: Path, only: tuple[str, ...], output: Path) -> None:
    """Print a line for every asset and write all as JSON."""
    for name, found in measured(models, assets, only, output, measure).items():
        networks = found["networks"]["bytes"]
        click.echo(f"{name:<24}{networks:>8} of networks, {found['at_equal_error']}")


if __name__ == "__main__":
    main()
