"""All that is known of an asset before anything is learned: its frame, inside, charts, symmetry."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import ChartTable, Frame
from nispcodec.geometry.chart_cuts import split_self_seams
from nispcodec.geometry.chart_merging import Cover, merge_charts
from nispcodec.geometry.charts import Charts, split_charts
from nispcodec.geometry.config import GeometryConfig, MergingConfig, SymmetryConfig
from nispcodec.geometry.distance import DistanceField
from nispcodec.geometry.labeling import Labeling, chart_table, with_openings
from nispcodec.geometry.openings import crossings
from nispcodec.geometry.solid import Solid, build_solid
from nispcodec.geometry.surface_points import laplace_offsets, raised, solid_surface
from nispcodec.geometry.symmetry import Symmetry, find_symmetry, folded, mirrored_charts
from nispcodec.geometry.welding import welded


@dataclass(frozen=True)
class Analysis:
    """One asset, analyzed.

    mesh             the asset, in the world frame; all else is in the normalized frame
    frame            from the normalized frame to the world
    patches          the charts of the mesh, cut where they meet themselves
    label            distance, chart (after merging) and UV of any points
    symmetry         about which planes it is symmetric
    closing_points   (k, 3) on surfaces that close openings; none where there are no openings
    """

    mesh: TexturedMesh
    frame: Frame
    patches: Charts
    label: Labeling
    symmetry: Symmetry
    closing_points: Float64Array
    config: GeometryConfig

    @property
    def field(self) -> DistanceField:
        """The signed distance."""
        return self.label.field

    @property
    def solid(self) -> Solid:
        """The part of the mesh that a signed distance can hold."""
        return self.label.field.solid

    @property
    def table(self) -> ChartTable:
        """The charts as the file has them, and the map of the UVs."""
        return self.label.table


def analyze(
    mesh: TexturedMesh,
    seed: int = 0,
    config: GeometryConfig = GeometryConfig(),
    frame: Frame | None = None,
) -> Analysis:
    """Analyze an asset: the same mesh and seed, the same analysis.

    The mesh is in the world frame. `frame` is that of the asset which the mesh is a part of; None:
    the normalized frame of the mesh. Raises MeshError when nothing of it can be held by a signed
    distance.
    """
    random = np.random.default_rng([seed, 0])
    frame = frame or normalizing_frame(mesh)
    normalized = replace(mesh, positions=frame.to_normalized(mesh.positions))
    welding = welded(mesh)
    solid = build_solid(normalized.corners, welding, config.solid)
    field = DistanceField(solid, config.solid)
    patches = split_charts(mesh, welding)
    if config.merging:
        patches = split_self_seams(mesh.corners, welding, patches)
    table = chart_table(mesh, patches, config.filled_atlas)
    label = Labeling(field, normalized, patches, table)
    symmetry = find_symmetry(label, config.symmetry)
    closing = np.zeros((0, 3))
    if config.merging:
        charts = _merged(label, symmetry, random, config.merging, config.symmetry)
        table = chart_table(mesh, charts, config.filled_atlas)
        label = replace(label, charts=charts, table=table)
        closing = _closing_points(field, random, config)
    if len(closing):
        label = replace(label, table=with_openings(table))
    return Analysis(mesh, frame, patches, label, symmetry, closing, config)


def normalizing_frame(mesh: TexturedMesh) -> Frame:
    """The normalized frame of a mesh: bounding-box center at 0, farthest vertex at radius 1.

    Only vertices that faces use count.
    """
    used = mesh.positions[np.unique(mesh.faces)]
    center = (used.min(axis=0) + used.max(axis=0)) / 2
    radius = float(np.linalg.norm(used - center, axis=1).max())
    return Frame((float(center[0]), float(center[1]), float(center[2])), radius)


def _merged(
    label: Labeling,
    symmetry: Symmetry,
    random: np.random.Generator,
    merging: MergingConfig,
    mirroring: SymmetryConfig,
) -> Charts:
    """Merge charts, told by random points and one point of each piece of small charts."""
    solid, charts = label.field.solid, label.charts
    points, piece = solid_surface(random, solid, merging.points)
    chart = charts.face_charts[solid.parents]
    rare = np.bincount(chart[piece], minlength=len(charts))[chart] < merging.rare
    centers = raised(random, solid, solid.pieces[rare].mean(axis=1), np.flatnonzero(rare))
    points = np.concatenate([points, centers])
    surface = label(points, signed=False)
    seen, uvs = folded(points, symmetry.uv), surface.uv.astype(np.float64)
    cover = Cover(points, surface.chart, seen, uvs)
    alike = mirrored_charts(label, surface, symmetry.uv, mirroring)
    return merge_charts(charts, cover, alike, merging)


def _closing_points(
    field: DistanceField, random: np.random.Generator, config: GeometryConfig
) -> Float64Array:
    """Points (k, 3) on closing surfaces; none where these are not worth a chart."""
    surface, _ = solid_surface(random, field.solid, config.openings.probes)
    probes = laplace_offsets(random, surface, config.openings.probe_spread, config.cube)
    # As labels have them: the single precision of samples.
    found = crossings(field, probes.astype(np.float32).astype(np.float64), random, config.openings)
    return found if len(found) >= config.openings.notable * len(probes) else found[:0]
