"""Every metric of two assets at once: the distortion of a decode."""

from __future__ import annotations

import numpy as np

from nispcodec.asset import TexturedMesh
from nispcodec.metrics.charts import Chooser, chart_accuracy
from nispcodec.metrics.color import color_psnr
from nispcodec.metrics.geometry import (
    Matches,
    d1_psnr,
    d2_psnr,
    distance_summary,
    normal_consistency,
)
from nispcodec.metrics.parameterisation import distortion_summary
from nispcodec.metrics.sides import sides_of
from nispcodec.metrics.spurious import spurious_components
from nispcodec.metrics.surface import Array, Surface, SurfacePoints, frame_of
from nispcodec.metrics.uv import uv_at, uv_errors, uv_summary

Directions = dict[str, Matches]
Group = dict[str, float | dict[str, float]]
Report = dict[str, Group]


def compare(
    original: TexturedMesh,
    decoded: TexturedMesh,
    *,
    samples: int = 100_000,
    seed: int = 0,
    model: Chooser | None = None,
) -> Report:
    """Distortion of `decoded` against `original`, in the normalised frame of the original.

    `samples` points are drawn from each surface, uniformly by area; of those on the original only
    the outer ones count. The chart accuracy is there when the `model` to ask is given; uv when
    the original has UVs. The same seed gives the same numbers.
    Raises MeshError when a mesh has no surface.
    """
    frame = frame_of(original)
    first, second = Surface.of(original, frame), Surface.of(decoded, frame)
    points = first.sample(samples, np.random.default_rng([seed, 0]))
    sides = sides_of(first, points)
    seen = points[sides.outer]
    others = second.sample(samples, np.random.default_rng([seed, 1]))
    directions = _match(first, second, seen, others)
    report: Report = {
        "surface": {"hidden": float(sides.hidden.mean()), "sheet": float(sides.sheet.mean())},
        "geometry": _geometry(first, second, directions),
        "spurious": {**spurious_components(decoded, original)},
    }
    if original.has_uv.any():
        report["uv"] = _uv(first, second, directions)
        report["parameterisation"] = _parameterisation(first, second)
    report["color"] = {"psnr": color_psnr(first, second, directions.values())}
    if model is not None:
        report["charts"] = _charts(first, seen, frame.to_world(seen.positions), model)
    return report


def _match(
    original: Surface, decoded: Surface, on_original: SurfacePoints, on_decoded: SurfacePoints
) -> Directions:
    return {
        "original_to_decoded": Matches(on_original, decoded.closest(on_original.positions)),
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


def _charts(original: Surface, seen: SurfacePoints, world: Array, model: Chooser) -> Group:
    materials = original.mesh.face_materials[seen.faces]
    return {"accuracy": chart_accuracy(model, world, uv_at(original, seen), materials)}


def _parameterisation(original: Surface, decoded: Surface) -> Group:
    return {"original": distortion_summary(original), "decoded": distortion_summary(decoded)}


def _with_larger(directions: dict[str, dict[str, float]]) -> Group:
    names = next(iter(directions.values()), {})
    larger = {name: max(each[name] for each in directions.values()) for name in names}
    return {**directions, "larger": larger}
