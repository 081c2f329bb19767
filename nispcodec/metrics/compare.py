"""Every metric of two assets at once: the distortion of a decode."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import Frame
from nispcodec.core.extras import require
from nispcodec.metrics.charts import Chooser, chart_accuracy
from nispcodec.metrics.color import color_psnr
from nispcodec.metrics.geometry import (
    Matches,
    d1_psnr,
    d2_psnr,
    distance_summary,
    normal_consistency,
)
from nispcodec.metrics.normal_maps import angle_summary, normal_angles
from nispcodec.metrics.parameterization import distortion_summary
from nispcodec.metrics.sides import Sides, sides_of
from nispcodec.metrics.spurious import spurious_components
from nispcodec.metrics.surface import Surface, SurfacePoints, frame_of
from nispcodec.metrics.uv import uv_at, uv_errors, uv_summary

Directions = dict[str, Matches]
Group = dict[str, float | dict[str, float]]
Report = dict[str, Group]


@dataclass(frozen=True)
class Reference:
    """An original, ready to be compared with any number of decodes; see `compare`.

    surface   in its normalized frame
    frame     that frame's place in the world
    sides     of all the points drawn from the surface
    seen      those of the points that are not hidden
    samples   how many points are drawn from each surface
    seed      of the random points
    """

    surface: Surface
    frame: Frame
    sides: Sides
    seen: SurfacePoints
    samples: int
    seed: int

    @classmethod
    def of(cls, original: TexturedMesh, *, samples: int = 100_000, seed: int = 0) -> Reference:
        """Draw the points of an original in the world frame.

        Raises MeshError when it has no surface, NispError without the extra `render`.
        """
        require("igl", extra="render", what_for="comparing")
        frame = frame_of(original)
        surface = Surface.of(original, frame)
        points = surface.sample(samples, np.random.default_rng([seed, 0]))
        sides = sides_of(surface, points)
        return cls(surface, frame, sides, points[sides.outer], samples, seed)

    def compare(self, decoded: TexturedMesh, model: Chooser | None = None) -> Report:
        """Distortion of one decode in the world frame, as `compare` has it.

        Raises MeshError when it has no surface or a texture does not decode.
        """
        original, second = self.surface, Surface.of(decoded, self.frame)
        others = second.sample(self.samples, np.random.default_rng([self.seed, 1]))
        directions = _match(original, second, self.seen, others)
        hidden, sheet = self.sides.hidden.mean(), self.sides.sheet.mean()
        report: Report = {
            "surface": {"hidden": float(hidden), "sheet": float(sheet)},
            "geometry": _geometry(original, second, directions),
            "spurious": {**spurious_components(decoded, original.mesh)},
        }
        if original.mesh.has_uv.any():
            report["uv"] = _uv(original, second, directions)
            report["parameterization"] = _parameterization(original, second)
        report["color"] = {"psnr": color_psnr(original, second, directions.values())}
        angles = normal_angles(original, second, directions["original_to_decoded"])
        if len(angles):
            report["normal_map"] = {**angle_summary(angles)}
        if model is not None:
            world = self.frame.to_world(original.outlook(self.seen))
            report["charts"] = _charts(original, self.seen, world, model)
        return report


def compare(
    original: TexturedMesh,
    decoded: TexturedMesh,
    *,
    samples: int = 100_000,
    seed: int = 0,
    model: Chooser | None = None,
) -> Report:
    """Distortion of `decoded` against `original`, in the normalized frame of the original.

    Both meshes are in the world frame. `samples` points are drawn from each surface, uniformly by
    area; of those on the original only the outer ones count. The chart accuracy is there when the
    `model` to ask is given, uv and parameterization when the original has UVs, and the angles of
    normal maps in degrees when both have some. The same seed gives the same numbers.
    Raises MeshError when a mesh has no surface or a texture does not decode.
    """
    return Reference.of(original, samples=samples, seed=seed).compare(decoded, model)


def _match(
    original: Surface, decoded: Surface, on_original: SurfacePoints, on_decoded: SurfacePoints
) -> Directions:
    seen = decoded.closest(original.outlook(on_original))
    return {
        "original_to_decoded": Matches(on_original, seen),
        "decoded_to_original": Matches(original.closest(on_decoded.positions), on_decoded),
    }


def _geometry(original: Surface, decoded: Surface, directions: Directions) -> Group:
    peak = original.diagonal
    both = directions.values()
    return {
        **_with_larger(
            {name: distance_summary(each.distances) for name, each in directions.items()}
        ),
        "d1_psnr": d1_psnr(both, peak),
        "d2_psnr": d2_psnr(original, both, peak),
        "normal_consistency": min(normal_consistency(original, decoded, each) for each in both),
    }


def _uv(original: Surface, decoded: Surface, directions: Directions) -> Group:
    errors = {name: uv_errors(original, decoded, each) for name, each in directions.items()}
    return _with_larger({name: uv_summary(each) for name, each in errors.items() if len(each)})


def _charts(original: Surface, seen: SurfacePoints, world: Float64Array, model: Chooser) -> Group:
    materials = original.mesh.face_materials[seen.faces]
    return {"accuracy": chart_accuracy(model, world, uv_at(original, seen), materials)}


def _parameterization(original: Surface, decoded: Surface) -> Group:
    return {"original": distortion_summary(original), "decoded": distortion_summary(decoded)}


def _with_larger(directions: dict[str, dict[str, float]]) -> Group:
    names = next(iter(directions.values()), {})
    larger = {name: max(each[name] for each in directions.values()) for name in names}
    return {**directions, "larger": larger}
