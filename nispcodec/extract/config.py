"""Every tuned number of the extraction, with its unit and the reason for it.

Lengths and areas are in the normalized frame (radius 1) unless said.
"""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class ResolutionConfig:
    """How many cells along the cube's edge, where nobody says.

    least            what most assets need ...
    most             ... and what those with thin walls get at most, as triangles allow
    thin_share       share of the surface with walls thinner than a cell from which on walls count
                     as thin
    faces            triangles that thin walls may cost
    faces_per_block  of the surface that `least` cells are looked into
    bytes_per_face  of memory that extraction takes at its peak: 260 to 300 were seen, and the count
                    of faces may be low by a quarter
    highest          cells of anything nobody asked for: memory grows with the square
    wall_samples     blocks of the surface, at least, that thin walls are looked for in
    newton_steps     that bring a point near the surface onto it, before walls are measured
    on_surface       a field smaller than this is at the surface
    """

    least: int = 256
    most: int = 512
    thin_share: float = 0.02
    faces: int = 500_000
    faces_per_block: float = 6.6
    bytes_per_face: int = 400
    highest: int = 2048
    wall_samples: int = 20_000
    newton_steps: int = 3
    on_surface: float = 1e-3


@dataclass(frozen=True)
class GridConfig:
    """Grids of signed distances.

    margin  spacings around the surface, at least: half the width of OpenVDB's narrow bands
    least   samples along the longest side: fewer leave none between the margins
    most    ... more are four gigabytes and hours
    """

    margin: int = 3
    least: int = 16
    most: int = 1024


@dataclass(frozen=True)
class IsosurfaceConfig:
    """How the zero set is found and where its vertices lie.

    root          blocks along the cube's edge that the search starts from
    margin        how much faster than measured the field may grow
    newton_steps  that bring vertices onto the zero set
    clearance     share of a cell that vertices keep from grid points, where several would coincide
    """

    root: int = 32
    margin: float = 1.25
    newton_steps: int = 2
    clearance: float = 0.01


@dataclass(frozen=True)
class ComponentConfig:
    """Which connected components are noise of the field.

    Slopes are relative to the whole surface's.

    steep               noise between the samples was seen at 3 to 7
    small_share         of all vertices: larger components are no noise, however steep
    flat                components below are mostly scraps of real detail that the fit could not
                        hold: only isolated ones are dropped
    small_area          of a component that may be dropped for being flat and isolated ...
    isolated            ... which it is with no other component so near
    single_cell         vertices of a flat component about one cell, of which the grid tells no
                        shape: meshes go without. Rays do not, as what is left out for them is left
                        out by larger cells
    hollow_share        of all vertices, below which a closed hollow is dropped
    slope_samples       vertices that tell the whole surface's slope
    neighbor_vertices   among which the nearest of another component is looked for: one is near any
                        place on the surface, a quarter of `isolated` or less away
    """

    steep: float = 1.7
    small_share: float = 0.05
    flat: float = 0.6
    small_area: float = 3e-3
    isolated: float = 0.02
    single_cell: int = 8
    hollow_share: float = 0.03
    slope_samples: int = 20_000
    neighbor_vertices: int = 200_000


@dataclass(frozen=True)
class SeamConfig:
    """Where charts meet.

    splits          rounds in which edges get a vertex where a third chart shows between their ends
    small_area      a patch of one chart that is smaller is a mistake of the field ...
    small_vertices  ... and so is one of fewer vertices
    votes           rounds in which neighbors decide whose it is
    bisections      that find the border on an edge
    clearance       share of an edge that cuts keep from its ends: no needles, no empty triangles
    """

    splits: int = 8
    small_area: float = 1.2e-4
    small_vertices: int = 2
    votes: int = 3
    bisections: int = 8
    clearance: float = 0.02


@dataclass(frozen=True)
class SimplifyConfig:
    """Fewer triangles.

    share           of the file's own distance error that simplifying may add, where nobody says how
                    many triangles are wanted: both together are hardly more than the first
    usual           distance that it may add to a file that does not tell its error ...
    finest          ... at least, as 16 bits of a position are no finer ...
    coarsest        ... and at most: facets show from here on
    most            triangles, where nobody says anything: a page or a game takes no more gladly
    bare            share of the triangles allowed that the surface has before seams are cut: of
                    60,000 these were seen to take 3 to 8 %
    first           triangles that the search for the fewest begins with, as a share of all
    slope           exponent of triangles by distance: as many are tried next as it foretells ...
    shrinkage       ... but no less than this share of the last ...
    more            ... or this many times them, where they were too few ...
    close           ... and none where they would be more than this share
    measured        triangles that distances are measured on in this search
    fitting         share of a simplified surface's distance that fitting leaves at most: 0.72 to
                    0.85 were seen
    aggressiveness  how eagerly long edges collapse, 0 to 10: above 5 thin parts fold over, below 5
                    counts are missed
    roughness       share of a cell by which vertices are moved first: on exactly flat parts all
                    quadrics are 0 and collapses get stuck
    step            share of the mean distance around a vertex that it is moved by: its neighbors
                    move too
    face_fittings   tries to meet a number of faces, seams included
    stuck           times as many faces as aimed at: then it is of no use to aim lower
    retreat         how far the copies of a vertex draw back to their own faces, as a share of
                    these faces' size
    """

    share: float = 0.35
    usual: float = 1e-4
    finest: float = 2e-5
    coarsest: float = 2e-4
    most: int = 60_000
    bare: float = 0.9
    first: float = 0.125
    slope: float = 1.5
    shrinkage: float = 0.4
    more: float = 1.5
    close: float = 0.95
    measured: int = 15_000
    fitting: float = 0.85
    aggressiveness: int = 5
    roughness: float = 1e-3
    step: float = 0.7
    face_fittings: int = 8
    stuck: float = 2.0
    retreat: float = 1e-3


@dataclass(frozen=True)
class SliverConfig:
    """Which faces of a simplified surface are mended.

    aspect   square of the longest side over the area seen along the field's normal, 2.3 for the
             best of triangles: worse ones show in shading, better ones follow what is long
    turned   what is said of worse ones, and of faces that are turned over
    told     length of the mean of the normals at a face's corners below which they tell no side, as
             across thin walls: its own shape counts then
    give     share of a bad face's longest side that the surface may move by
    stray    the same of borders between charts
    slides   shares of an edge that a vertex may slide along it
    worth    share of the squares of badness around a vertex that its move takes away, at least:
             many small steps take long and lead nowhere
    rounds   in each of which every vertex changes once at most
    """

    aspect: float = 50.0
    turned: float = 1e4
    told: float = 0.8
    give: float = 0.05
    stray: float = 0.05
    slides: tuple[float, ...] = (0.1, 0.25, 0.5)
    worth: float = 0.002
    rounds: int = 32


@dataclass(frozen=True)
class LevelConfig:
    """Levels of detail.

    share      of a level's triangles that the next one has: from twice as far, a surface covers a
               quarter of the pixels
    least      triangles of any level: fewer enclose nothing, and one is half a sheet
    uv_weight  error of one unit of UV against the asset's extent, for mesh parts: from afar shapes
               count more than textures
    error      largest one of mesh parts, as a share of the extent: where some bodies get no
               coarser, the others would pay for them with all of their shape
    reach      how far off the finest level a vertex of mesh parts may be, normalized frame: farther
               ones are spikes
    """

    share: float = 0.25
    least: int = 4
    uv_weight: float = 1.0
    error: float = 0.05
    reach: float = 0.05


@dataclass(frozen=True)
class ExtractConfig:
    """All of them."""

    resolution: ResolutionConfig = field(default_factory=ResolutionConfig)
    isosurface: IsosurfaceConfig = field(default_factory=IsosurfaceConfig)
    components: ComponentConfig = field(default_factory=ComponentConfig)
    seams: SeamConfig = field(default_factory=SeamConfig)
    simplify: SimplifyConfig = field(default_factory=SimplifyConfig)
    slivers: SliverConfig = field(default_factory=SliverConfig)
    levels: LevelConfig = field(default_factory=LevelConfig)
