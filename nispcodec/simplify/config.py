"""The tuned numbers of simplification, each with its unit and reason; measured in decision 0198."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class CollapseConfig:
    """How edges are collapsed.

    uv_weight     error of one unit of UV against the asset's extent; between 1 and 10 distances
                  hardly change, and UVs are better at 10
    error         largest one, as a share of the extent: what is bounded ends with more triangles
    notable_area  share of the area that small bodies may lose before none may be dropped
    card_faces    bodies of so few faces are kept as they are then: leaves, planks, bolts
    """

    uv_weight: float = 10.0
    error: float = 1.0
    notable_area: float = 0.02
    card_faces: int = 12


@dataclass(frozen=True)
class SolverConfig:
    """When conjugate gradients end: closest points change after each solution anyway.

    steps      at most
    tolerance  the part of the residual that may remain
    """

    steps: int = 40
    tolerance: float = 0.1


@dataclass(frozen=True)
class FitConfig:
    """How positions and UVs are moved towards the source.

    rounds       times that closest points are found and vertices moved
    uv_rounds    times that UV errors are weighed anew
    samples      points on each surface for every vertex that is moved
    fewest       points at least; few vertices still need points on every part
    most         points at most: time
    sliding      weight of what lies along the surface against what lies across it: vertices slide,
                 but not freely
    seam_weight  weight of a seam's place against the surface's: at a wrong place, points beside it
                 get UVs of another chart
    seam_sliding weight of what lies along a seam, or off the surface, against what lies beside it
    curve_samples  points on the source's borders, and seams, for every such edge
    curve_fewest   points at least
    softness     distances below this part of the mean count by their square, above by themselves
    damping      weight of the last place, as part of the mean weight: for vertices no point speaks
    uv_damping   the same for UVs
    turn         cosine of the angle by which a face may turn in a round
    halvings     of a move that turns faces over, before all of it is taken back
    far          times the mean distance before the fit that a vertex may be from the source: where
                 nearly no point speaks for one, least squares may send it anywhere
    least_far    how far it may be for all that, normalized frame: where faces are flat and large,
                 means are tiny, and single corners have to move by a hundred times as much
    reach        how far it may be at most, normalized frame: unbounded where means of distances are
                 what counts, as single spikes make few triangles nearer on the mean
    """

    rounds: int = 8
    uv_rounds: int = 5
    samples: float = 12.0
    fewest: int = 8000
    most: int = 60000
    sliding: float = 0.005
    seam_weight: float = 0.5
    seam_sliding: float = 0.02
    curve_samples: float = 6.0
    curve_fewest: int = 500
    softness: float = 0.3
    damping: float = 0.01
    uv_damping: float = 0.001
    turn: float = 0.3
    halvings: int = 3
    far: float = 10.0
    least_far: float = 0.01
    reach: float = math.inf
    solver: SolverConfig = SolverConfig()


@dataclass(frozen=True)
class CopiesConfig:
    """Which bodies are held once.

    fewest        faces of such a body: a placement takes 30 bytes, and of leaves of 72 faces so few
                  are left in coarse candidates that these took half the bytes of their placements
    fewest_left   faces that simplifying must leave of it, else its copies are faces like others
    tolerance     largest distance of a copy's corners from where a placement has them, normalized
                  frame: below what rounding moves
    uv_tolerance  the same of UVs
    alike         bodies whose areas by squares of sizes differ by more than this are not compared
    most_tried    bodies that one is compared with: where many differ, time
    """

    fewest: int = 100
    fewest_left: int = 8
    tolerance: float = 1e-4
    uv_tolerance: float = 1e-4
    alike: float = 0.02
    most_tried: int = 16


@dataclass(frozen=True)
class CreaseConfig:
    """Which edges of simplified triangles are creases.

    along       shares of an edge's length at which the source's normals beside it are looked up
    inset       how far from the edge that is, as part of the way to the face's third corner: more
                than positions are off, and little enough for smooth normals to differ little there
    jump        part of the turn of an edge's faces by which the normals must differ
    flat        radians: edges that turn by less look alike either way
    free        part of their shading's error by which sharp edges, and none, are judged: these take
                no bytes, others up to 4 % of a part's
    negligible  share of the bent edges that may be other than by the rule for parts that say none
    """

    along: tuple[float, ...] = (0.25, 0.5, 0.75)
    inset: float = 0.12
    jump: float = 0.5
    flat: float = 0.035
    free: float = 0.85
    negligible: float = 0.005


@dataclass(frozen=True)
class RoundingConfig:
    """How positions are rounded, by weights against that of moving the surface across.

    sliding  of moving a vertex along it: textures move too
    seam     of moving one off a seam, or a border
    sweeps   over all vertices: neighbors make up for each other from the second on ...
    share    ... in each of which so many are rounded anew
    turn     cosine of the angle by which a face may turn
    """

    sliding: float = 0.01
    seam: float = 1.0
    sweeps: int = 5
    share: float = 0.4
    turn: float = 0.5


@dataclass(frozen=True)
class DiscoloredConfig:
    """Which places of a simplified surface have lost their color, and how they get it back.

    neighbors  points over which colors are meant: of 20,000, about 1.5 % of the radius around each
    notable    difference of such means from which on one sees it, sRGB-encoded
    beside     vertices of faces up to so far from such points stay, normalized frame
    most_kept  vertices that may stay, as a share of the faces asked for: where there are more, all
               is coarse, and other places would pay for these
    """

    neighbors: int = 12
    notable: float = 0.15
    beside: float = 0.02
    most_kept: float = 0.015


@dataclass(frozen=True)
class LadderConfig:
    """Which candidates are made.

    samples       points on each surface that errors are measured with
    fewest        faces of the first candidate
    step          of the grid, for a mean distance of 1: fewer faces save as much as fewer bits ...
    whole_step    ... and where all faces are kept, whose vertices are rounded to the nearest
    uv_step       of the grid of UVs, for a UV error of 1
    tolerance     mean distance below which rounding need not go, normalized frame
    uv_tolerance  the same of UVs
    """

    samples: int = 20000
    fewest: int = 150
    step: float = 3.6
    whole_step: float = 1.8
    uv_step: float = 1.8
    tolerance: float = 5e-5
    uv_tolerance: float = 1e-4
    collapse: CollapseConfig = CollapseConfig()
    fit: FitConfig = FitConfig()
    copies: CopiesConfig = CopiesConfig()
    rounding: RoundingConfig = RoundingConfig()
    discolored: DiscoloredConfig = DiscoloredConfig()


@dataclass(frozen=True)
class SearchConfig:
    """How the fewest faces within an error are found.

    first       a search begins in the middle between so many faces and all
    trials      face counts that are tried at most
    close       the search ends where the error is within this share of the one asked for
    slopes      of errors by faces, both as logarithms: the steepest and the flattest believed
    uneven      how much farther from its limit the distance may be than the UVs, as a logarithm,
                before finer positions are tried
    fewer       the part of the faces that finer positions may save: that search begins between
    helping     a bit more of UVs helps where the UV error falls below this part
    uv_blur     UV error up to which UVs may be rounded at most, whatever is asked for: where the
                mean is that of seams, what lies between them would be blurred; 1.5 pixels of 1,000
    nearly_all  from this share of the faces on, all of them are tried too: nothing moves there
    """

    first: int = 100
    trials: int = 7
    close: float = 0.04
    slopes: tuple[float, float] = (3.0, 0.4)
    uneven: float = 0.15
    fewer: float = 0.7
    helping: float = 0.9
    uv_blur: float = 1.5e-3
    nearly_all: float = 0.6


@dataclass(frozen=True)
class DescentConfig:
    """How the candidate of the least loss is found, step by step.

    growth       of the faces from one rung to the next, below all of them
    first_faces  about as many has the first candidate, ...
    first_bits   ... and so many bits of positions and of UVs: spot's pictures were best for their
                 bytes at 10 or 11 bits, from an eighth of the faces to all of them
    least_bits   of positions and of UVs
    steps        of rungs, bits and UV bits, in turn
    trials       candidates at most: each takes a second or two
    """

    growth: float = 1.41
    first_faces: int = 2000
    first_bits: tuple[int, int] = (10, 10)
    least_bits: int = 5
    steps: tuple[tuple[int, int, int], ...] = (
        (3, 0, 0),
        (1, 0, 0),
        (0, 1, 1),
        (0, 0, 1),
        (0, 1, 0),
    )
    trials: int = 24
