"""How far a part is from the original, as `nispcodec.metrics` measures it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from nispcodec.core.arrays import BoolArray
from nispcodec.core.asset import Material, TexturedMesh
from nispcodec.core.errors import MeshError
from nispcodec.core.mesh_part import MeshPart
from nispcodec.geometry.config import WindingConfig
from nispcodec.geometry.winding import Winding
from nispcodec.metrics.faulty_points import FAR, FaultyPoints
from nispcodec.metrics.geometry import Matches
from nispcodec.metrics.paint import Paint
from nispcodec.metrics.sides import sides_of
from nispcodec.metrics.surface import Surface, SurfacePoints
from nispcodec.metrics.uv import uv_errors
from nispcodec.simplify.closest import Tree
from nispcodec.simplify.triangles import Triangles


@dataclass(frozen=True)
class Errors:
    """The larger of both directions; distances in the normalized frame, UVs in the asset's.

    distance, uv  means; distance_p99, uv_median; 0 for UVs where the original has none
    color         root of the mean square of base colors, sRGB-encoded, of both directions together;
                  0 where none are known
    made_up       points of the part that are far from the original
    lost          points of the original, of counted faces, that are far from the part
    far_part      what far points add to the distance
    """

    distance: float
    distance_p99: float
    uv: float
    uv_median: float
    color: float = 0.0
    made_up: FaultyPoints = field(default_factory=FaultyPoints, compare=False)
    lost: FaultyPoints = field(default_factory=FaultyPoints, compare=False)
    far_part: float = 0.0

    def within(self, distance: float, uv: float) -> bool:
        """Whether both means are at most so large."""
        return self.distance <= distance and self.uv <= uv

    def beside(self, other: Errors, share: float) -> Errors:
        """Those of a surface of which this is a share, and another part the rest.

        Far points are those of this part alone; of p99 and median they are estimates.
        """

        def mean(own: float, others: float) -> float:
            return share * own + (1 - share) * others

        return Errors(
            distance=mean(self.distance, other.distance),
            distance_p99=max(self.distance_p99, other.distance_p99),
            uv=mean(self.uv, other.uv),
            uv_median=mean(self.uv_median, other.uv_median),
            color=math.sqrt(mean(self.color**2, other.color**2)),
            made_up=self.made_up.in_larger(share),
            lost=self.lost.in_larger(share),
            far_part=mean(self.far_part, other.far_part),
        )


@dataclass(frozen=True)
class Counted:
    """Which faces of an original (m,) a part is to hold.

    held   all of those
    inner  those of them inside other bodies that are seen through an opening: means leave them
           out, as no signed distance can hold them, but their loss counts
    """

    held: BoolArray
    inner: BoolArray

    @staticmethod
    def of(held: BoolArray) -> Counted:
        """These faces (m,) bool, none of them seen through an opening."""
        return Counted(held, np.zeros_like(held))

    def only(self, chosen: BoolArray) -> Counted:
        """The same of the chosen faces (m,) bool alone."""
        return Counted(self.held[chosen], self.inner[chosen])


@dataclass(frozen=True)
class Original:
    """A surface that parts are compared with, and points on it.

    points all that count: hidden ones do, where one sees their face through an opening
    outer  (n,) bool: those that are not hidden, which means are over
    tree   for closest points, of hidden faces too: nothing that is near these is made up
    paint  its base colors; None: they do not count
    """

    surface: Surface
    points: SurfacePoints
    outer: BoolArray
    tree: Tree
    seed: int
    paint: Paint | None = None

    @staticmethod
    def of(
        triangles: Triangles,
        tree: Tree,
        samples: int,
        seed: int,
        counted: Counted | None = None,
        paint: Paint | None = None,
    ) -> Original:
        """`samples` points on the original; of those only the ones on `counted` faces.

        Raises MeshError where no face has an area.
        """
        mesh = triangles.mesh()
        surface = Surface(mesh, mesh.positions)
        points = surface.sample(samples, np.random.default_rng([seed, 0]))
        if counted is not None and counted.held[points.faces].any():
            points = points[counted.held[points.faces]]
        outer = _outer(surface, points)
        if not outer.any():
            outer[:] = True
        seen = outer if counted is None else outer | counted.inner[points.faces]
        return Original(surface, points[seen], outer[seen], tree, seed, paint)

    def errors(self, decoded: TexturedMesh) -> Errors:
        """Errors of a mesh whose positions are in the normalized frame.

        All are infinite where none of its faces has an area.
        """
        other = Surface(decoded, decoded.positions)
        try:
            points = other.sample(len(self.points), np.random.default_rng([self.seed, 1]))
        except MeshError:
            return Errors(np.inf, np.inf, np.inf, np.inf)
        outer = _outer(other, points)
        points = points[outer] if outer.any() else points
        there = self.matches(other)
        directions = [there[self.outer], Matches(self._closest(points), points)]
        misses = [uv_errors(self.surface, other, each) for each in directions]
        seen = [each for each in misses if len(each)]
        distance = max(float(each.distances.mean()) for each in directions)
        near = max(float((each.distances * (each.distances <= FAR)).mean()) for each in directions)
        return Errors(
            distance=distance,
            distance_p99=max(float(np.percentile(each.distances, 99)) for each in directions),
            uv=max((float(each.mean()) for each in seen), default=0.0),
            uv_median=max((float(np.median(each)) for each in seen), default=0.0),
            color=self._color(other, directions),
            made_up=FaultyPoints.of(decoded, points, directions[1].distances > FAR),
            lost=FaultyPoints.of(self.surface.mesh, self.points, there.distances > FAR),
            far_part=distance - near,
        )

    def matches(self, other: Surface) -> Matches:
        """All points, and the closest ones of another surface."""
        return Matches(self.points, other.closest(self.surface.outlook(self.points)))

    def _color(self, other: Surface, directions: Sequence[Matches]) -> float:
        if self.paint is None:
            return 0.0
        misses = [self.paint.misses(self.surface, other, each) for each in directions]
        return float(np.sqrt(np.concatenate(misses).mean()))

    def errors_from(self, part: TexturedMesh, samples: int) -> tuple[float, float]:
        """The mean distance and the mean UV error of so many points of a part: one direction only.

        As `errors`. Raises MeshError where no face of the part has an area.
        """
        other = Surface(part, part.positions)
        points = other.sample(samples, np.random.default_rng([self.seed, 2]))
        match = Matches(self._closest(points), points)
        misses = uv_errors(self.surface, other, match)
        return float(match.distances.mean()), float(misses.mean()) if len(misses) else 0.0

    def _closest(self, points: SurfacePoints) -> SurfacePoints:
        """As `Surface.closest`, by the tree that is there."""
        hits = self.tree.closest(points.positions)
        faces = self.surface.facing(hits.faces, hits.positions - points.positions)
        weights = self.surface.weights(faces, hits.positions)
        return SurfacePoints(faces, weights, hits.positions)


def _outer(surface: Surface, points: SurfacePoints) -> BoolArray:
    """(n,): the points of a surface that it does not hide."""
    faces = surface.mesh.faces
    often = 2 * len(points) > len(faces)
    winding = Winding(surface.positions, faces, WindingConfig(), often)
    return sides_of(surface, points, winding.about).outer


def mesh_of(part: MeshPart) -> TexturedMesh:
    """A part before any placement as a mesh in the normalized frame, of nameless materials."""
    return TexturedMesh(
        positions=part.normalized(),
        faces=part.faces,
        uvs=part.asset_uvs(),
        uv_faces=part.uv_faces,
        face_materials=part.chart_materials[part.face_charts],
        materials=(Material(),) * (int(part.chart_materials.max()) + 1),
    )
