"""Every tuned number of the geometry, with its unit and the reason for it.

Lengths are in the normalized frame (radius 1) unless said.
"""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class WindingConfig:
    """How many of its radii away a cluster of triangles is taken as one (Barill et al. 2018).

    radii          of our kernel's clusters: off by 0.03 at most ...
    rough          ... and where the side is clear, in a third of the time: of 80,000 points around
                   a helmet of 82 bodies and a car none was off by more than 0.16 ...
    margin         ... so that those so near to a half are looked at again
    libigl_radii   of libigl's clusters, which are counted otherwise: as near in three times the
                   time; half that of its default of 2 ...
    libigl_rough   ... and one in a hundred is off by more than 0.1
    """

    radii: float = 2.0
    rough: float = 1.25
    margin: float = 0.25
    libigl_radii: float = 1.5
    libigl_rough: float = 1.0


@dataclass(frozen=True)
class SolidConfig:
    """Which parts of a mesh are inside, hidden, or an open surface.

    probe_offset      how far off a face one looks to tell which of its sides are inside
    half_thickness    given to open surfaces: a field that is thinner would not be learned
    thin_wall         walls thinner than this have no inside to speak of: open surfaces
    coarse_edge       faces are subdivided until no edge is longer than this ...
    fine_edge         ... and, where they are partly hidden, than this
    doubt             a winding number so near to a half beside a face tells no side
    winding           how exact winding numbers are
    facing            cosine from which on the closest piece tells the side of a point: only walls
                      that meet at less than 25 degrees could be mistaken
    whole             a piece tells none unless winding numbers beside it are so near to whole ones
    gap_margin        ... nor points so much further away than the nearest gap or rim: pieces that
                      are hidden in part leave gaps of up to half `fine_edge`
    rim_step          the rim of openings is looked at so often
    weld              positions at rims that are nearer than this are one: rounding to single
                      precision opens seams; at 1e-5 thin parts of a real asset were joined
    gap               ... and those further apart are told of: single precision, at the radius,
                      leaves 6e-8 between them, and nobody sees that
    partners          positions at most that one is joined with itself; those are with others
    clear_majority    an open patch, of which some was wound against the rest, is the right way
                      round with such a majority of its area
    bulge             an open patch that holds such a volume, for its area^1.5, has an outside: a
                      sphere holds 0.09, half of one 0.02 to 0.03
    crossing          a body that is inside out is turned where at least such a share of its area
                      lies inside others, and outside, ...
    crossing_points   ... at about so many points of it, at least
    seam              sides of two bodies whose middles are nearer than this run along one seam:
                      formats that keep each part in 11 bits leave as much between them, ...
    seam_share        ... but no farther apart than such a share of the shorter side
    seam_cosine       ... and with an angle between them of at least such a cosine
    escape            an opening, or the inside of a sheet, from which such a share of rays meets
                      nothing is not closed by other bodies
    leak              the same of a sheet whose rim hangs free ...
    hanging           ... as such a share of it is away from all others: panels of a room meet
    rays              that ask for it, of each opening and sheet
    sight_rays        about so many from all faces inside other bodies: one that gets away from a
                      face says that it is seen ...
    few_rays          ... but no fewer of each face ...
    many_rays         ... and no more
    sight_offset      how far off the face they begin
    open_share        a body whose exposed openings have this share of its area is open
    undecided         an opening is exposed where the winding number is so near to a half ...
    plugged_gap       ... and the mesh further away than this
    card_share        a body whose openings have this share of its area is a double-sided sheet
    closing           a sheet that closes a body has a winding number so near to a whole one
    sheet_lift        how far in front of an open surface its points are looked for: of two faces
                      back to back the one on the same side is the closest
    """

    probe_offset: float = 2e-3
    half_thickness: float = 4e-3
    thin_wall: float = 1e-3
    coarse_edge: float = 0.1
    fine_edge: float = 0.03
    doubt: float = 0.05
    winding: WindingConfig = field(default_factory=WindingConfig)
    facing: float = 0.9
    whole: float = 0.1
    gap_margin: float = 0.01
    rim_step: float = 0.02
    weld: float = 1e-6
    gap: float = 2e-7
    partners: int = 4
    clear_majority: float = 0.2
    bulge: float = 0.02
    crossing: float = 0.02
    crossing_points: int = 500
    seam: float = 1e-3
    seam_share: float = 0.25
    seam_cosine: float = 0.95
    escape: float = 0.4
    leak: float = 0.03
    hanging: float = 0.95
    rays: int = 128
    sight_rays: int = 400_000
    few_rays: int = 32
    many_rays: int = 1024
    sight_offset: float = 1e-5
    open_share: float = 0.25
    undecided: float = 0.2
    plugged_gap: float = 0.02
    card_share: float = 0.7
    closing: float = 0.25
    sheet_lift: float = 1e-6


@dataclass(frozen=True)
class SymmetryConfig:
    """When an asset counts as its own mirror image.

    probes        random points near the surface that are asked
    jitter        standard deviation of how far they lie off it
    exact         mean difference of the distance up to which it is symmetric; assets modeled in two
                  halves stay below 1e-5, a small part on one side only makes 1e-4 to 2e-4 and
                  must not be lost
    alike         distances and texture coordinates that differ by less count as the same
    mostly_sdf    share of probes alike from which on the SDF gets a coordinate more
    mostly_uv     the same for charts and UVs
    mirrored      share of a chart's points whose image lies on its mirrored chart: charts may be
                  cut differently
    """

    probes: int = 2_000
    jitter: float = 5e-3
    exact: float = 3e-5
    alike: float = 2e-3
    mostly_sdf: float = 0.95
    mostly_uv: float = 0.9
    mirrored: float = 0.5


@dataclass(frozen=True)
class MergingConfig:
    """Which charts share a label.

    gap           charts some times further apart than this may
    points        on the surface by which neighbors are told
    rare          charts with fewer points get one for each of their faces
    ridge         variance below which a direction decides nothing: that across a flat chart
    floor         UVs nearer than this to an affine map are as good as on it
    extra_shares  how many more labels than are needed are tried
    worth         bits a point that twice the labels have to save
    sweeps        how often each chart is looked at again
    many          from so many charts on only the labels that are needed are tried, once
    """

    gap: float = 0.1
    points: int = 30_000
    rare: int = 20
    ridge: float = 1e-4
    floor: float = 1e-3
    extra_shares: tuple[float, ...] = (0.0, 0.125, 0.25, 0.5, 0.75, 1.0)
    worth: float = 3.0
    sweeps: int = 10
    many: int = 2000


@dataclass(frozen=True)
class OpeningsConfig:
    """Where the signed distance closes openings of the mesh.

    probes        random points near the surface from which closing surfaces are sought
    probe_spread  mean distance of the probes from the surface
    notable       share of probes that find one from which on openings get a chart
    clearance     a closing surface nearer to the mesh closes no opening to speak of
    stride        share of the way to the surface that a probe steps: it cannot cross it
    bisections    of the step that crosses a closing surface
    spreads       rounds in which found points look for others beside them
    children      points that each missing one is sought by in a round
    """

    probes: int = 50_000
    probe_spread: float = 1 / 60
    notable: float = 5e-4
    clearance: float = 6e-3
    stride: float = 0.9
    bisections: int = 6
    spreads: int = 12
    children: int = 2


@dataclass(frozen=True)
class GeometryConfig:
    """Every tuned number of the geometry.

    merging       None leaves charts as the mesh has them, and openings without a chart
    filled_atlas  UVs that fill so much of the unit square in both directions stay as they are: no
                  map to store
    cube          half the side of the cube that samples come from: the unit ball's, and some room
    """

    solid: SolidConfig = field(default_factory=SolidConfig)
    symmetry: SymmetryConfig = field(default_factory=SymmetryConfig)
    merging: MergingConfig | None = field(default_factory=MergingConfig)
    openings: OpeningsConfig = field(default_factory=OpeningsConfig)
    filled_atlas: float = 0.95
    cube: float = 1.05
