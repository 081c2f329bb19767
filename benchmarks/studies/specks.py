"""Specks: the share of a surface that shows a visibly wrong color, in meshes and in queries.

    python -m benchmarks.studies.specks --old OLD --models NEW --assets ../shared/assets

NEW holds NAME.nisp for the assets NAME, OLD holds NAME.glb: what an older build decoded its own
files to, as the format was another then. So meshes are compared, and queries only where they have
no specks at all. Results are kept asset by asset, those of the older build where OLD has no file.

A point is a speck where its luminance is more than `OFF` from that of the original, which is
smooth there, and from all that the original shows within `ALLOWED` of it. Smooth is where one chart
of the original keeps its luminance within `EVEN` as far as `NEAR`: another color beyond a seam is
no edge. What no ray reaches from outside is none: a layer just behind another one, say.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import click
import numpy as np
from scipy.spatial import cKDTree

from benchmarks.measuring.model_records import measured, models_options
from benchmarks.measuring.result_file import Record, result_so_far
from benchmarks.measuring.target import Asked, Target, asked_of_each
from nispcodec.core.arrays import BoolArray, Float32Array, Float64Array, Int64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.connectivity import connected_faces, row_ids
from nispcodec.core.document import Frame
from nispcodec.core.texture import srgb_to_linear
from nispcodec.format import unpack
from nispcodec.geometry.rays import leaves, ways_beside
from nispcodec.io.load import load_mesh
from nispcodec.metrics.color import color_at
from nispcodec.metrics.sides import sides_of
from nispcodec.metrics.surface import Surface, SurfacePoints, frame_of
from nispcodec.model import NispModel

RESULTS = Path("benchmarks/results/specks.json")
OFF = 0.15
EVEN = 0.1
NEAR = 0.01
ALLOWED = 2e-3
"""Normalized frame: half a pixel of a picture of 512 that shows all of the asset."""
# Points of the original by which its colors about any are known, and how many of them are asked.
KNOWN = 400_000
NEIGHBORS = 24
# Rays that ask whether a point is seen, and how far in front of it they begin.
SIGHTS = 128
AHEAD = 1e-5
WAYS = np.array(np.meshgrid(*[[-1, 0, 1]] * 3)).reshape(3, -1).T / np.sqrt(3)
SAMPLES = 400_000
LOOKS = ("mesh", "queries")
HALVED = [Target(f"specks, {look}, new / old", ("ratios", look), 0.5) for look in LOOKS]
LUMINANCE = np.array([0.2126, 0.7152, 0.0722], np.float32)


@dataclass(frozen=True)
class Original:
    """What an original shows about any point: luminance and chart of random points on it.

    surface      in its frame
    face_charts  the chart of each of its faces (m,)
    tree         of the random points; an index beyond them is no point
    luminance    of each, NaN at the end
    charts       of each, -1 at the end
    """

    surface: Surface
    frame: Frame
    face_charts: Int64Array
    tree: cKDTree
    luminance: Float64Array
    charts: Int64Array

    @classmethod
    def of(cls, mesh: TexturedMesh, known: int = KNOWN) -> Original:
        """Look at `known` points. Raises MeshError for a texture that does not decode."""
        frame, charts = frame_of(mesh), _charts(mesh)
        surface = Surface.of(mesh, frame)
        points = surface.sample(known, np.random.default_rng([0, 0]))
        shown = np.append(luminance(color_at(surface, points)), np.nan)
        owners = np.append(charts[points.faces], -1)
        return cls(surface, frame, charts, cKDTree(points.positions), shown, owners)

    def smooth(self, points: SurfacePoints) -> BoolArray:
        """Where the original is smooth about points (n,) on it."""
        _, near = self.tree.query(points.positions, NEIGHBORS, distance_upper_bound=NEAR)
        own = self.charts[near] == self.face_charts[points.faces][:, None]
        shown = self.luminance[near]
        low = np.where(own, shown, np.inf).min(axis=1)
        high = np.where(own, shown, -np.inf).max(axis=1)
        even: BoolArray = own.any(axis=1) & (high - low <= EVEN)
        return even

    def specks(
        self, points: Float64Array, closest: SurfacePoints, shown: Float64Array
    ) -> BoolArray:
        """Which of points (n, 3) that show luminances (n,) are specks, where all is smooth."""
        found = np.abs(shown - luminance(color_at(self.surface, closest))) > OFF
        suspects = np.flatnonzero(found)
        if len(suspects):
            around = (points[suspects, None] + ALLOWED * WAYS).reshape(-1, 3)
            known = luminance(color_at(self.surface, self.surface.closest(around)))
            apart = np.abs(known.reshape(len(suspects), -1) - shown[suspects, None])
            found[suspects] = apart.min(axis=1) > OFF
        return found


def _charts(mesh: TexturedMesh) -> Int64Array:
    """The chart (m,) of each face: faces that share corners of the same position and UV."""
    corners = np.concatenate([mesh.corners, mesh.corner_uvs], axis=2).reshape(-1, 5)
    return connected_faces(row_ids(corners + 0.0).reshape(-1, 3)).astype(np.int64)


def luminance(colors: Float32Array) -> Float64Array:
    """Linear luminance (n,) of colors (n, 4), sRGB-encoded, by ITU-R BT.709."""
    found: Float64Array = (srgb_to_linear(colors[:, :3]) @ LUMINANCE).astype(np.float64)
    return found


def of_mesh(original: Original, decoded: Surface, samples: int) -> dict[str, float]:
    """Share of the smooth surface of a decoded mesh that are specks, and what share is smooth.

    What nobody sees, of either, is left out.
    """
    drawn = seen(decoded, decoded.sample(samples, np.random.default_rng([0, 1])))
    closest = original.surface.closest(drawn.positions)
    smooth = original.smooth(closest) & sides_of(original.surface, closest).outer
    drawn, closest = drawn[smooth], closest[smooth]
    found = original.specks(drawn.positions, closest, luminance(color_at(decoded, drawn)))
    found[found] = in_sight(decoded, drawn[found])
    return {"mesh": float(found.mean()), "smooth": float(smooth.mean())}


def seen_points(original: Original, samples: int) -> SurfacePoints:
    """Smooth points of an original to ask for colors, those left out that nobody sees."""
    drawn = original.surface.sample(samples, np.random.default_rng([0, 2]))
    points = seen(original.surface, drawn)
    return points[original.smooth(points)]


def seen(surface: Surface, points: SurfacePoints) -> SurfacePoints:
    """Those of the points on a surface that are not hidden within it."""
    return points[sides_of(surface, points).outer]


def in_sight(surface: Surface, points: SurfacePoints) -> BoolArray:
    """(n,): whether one sees points on a surface from outside: one of some rays gets away."""
    facing = surface.normals_at(points.faces).repeat(SIGHTS, axis=0)
    facing[::2] *= -1
    start = points.positions.repeat(SIGHTS, axis=0) + AHEAD * facing
    free = leaves(surface.corners, start, ways_beside(facing, np.random.default_rng([0, 3])))
    return np.asarray(free.reshape(-1, SIGHTS).any(axis=1))


def specks(original: Original, model: NispModel, samples: int = SAMPLES) -> dict[str, float]:
    """Shares of specks: `mesh`, of the extracted mesh; `queries`, of answers on the original."""
    points = seen_points(original, samples)
    answers = luminance(model.color(points.positions, frame="normalized"))
    found = original.specks(points.positions, points, answers)
    found[found] = in_sight(original.surface, points[found])
    decoded = Surface.of(model.to_mesh(), original.frame)
    return {**of_mesh(original, decoded, samples), "queries": float(found.mean())}


def asked(results: Record) -> Iterator[Asked]:
    """Of every asset: half of the old specks at most."""
    return asked_of_each(results["assets"], lambda name: HALVED)


@click.command(help=__doc__)
@click.option(
    "--old",
    type=click.Path(path_type=Path, exists=True),
    help="A folder of NAME.glb that the older build decoded.",
)
@models_options(RESULTS)
def main(old: Path | None, models: Path, assets: Path, only: tuple[str, ...], output: Path) -> None:
    """Measure what is not measured yet, and print asked against measured."""
    known = result_so_far(output).get("assets", {})
    records = measured(models, assets, only, output, partial(record, old, known))
    for each in asked({"assets": records}):
        click.echo(each.line())


def record(old: Path | None, known: Record, model: Path, original: Path) -> Record:
    """The shares of one file, those of the one of the same name in `old`, and new by old.

    Where `old` has none: those of it that are known.
    """
    asset = Original.of(load_mesh(original))
    found, before = shares(asset, model), known.get(model.stem, {}).get("old", {})
    decoded = old / model.with_suffix(".glb").name if old else None
    if decoded and decoded.exists():
        before = of_mesh(asset, Surface.of(load_mesh(decoded), asset.frame), SAMPLES)
    return {**found, "old": before, "ratios": ratios(found, before)}


def shares(original: Original, path: Path) -> Record:
    """The shares of one file, and whether it is a field or meshes."""
    document = unpack(path.read_bytes())
    held = [*(["field"] if document.field else []), *(["meshes"] if document.meshes else [])]
    return {"held_as": " and ".join(held), **specks(original, NispModel(document))}


def ratios(new: Record, old: Record) -> dict[str, float]:
    """Specks by those of the old file: no specks are 0 of any, others of an unknown one nothing."""
    known = [look for look in LOOKS if look in old or not new[look]]
    return {look: new[look] / max(old.get(look, 0), 1 / SAMPLES) for look in known}


if __name__ == "__main__":
    main()
