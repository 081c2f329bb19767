"""One picture a person can judge a decode by: both from all sides, where they differ, numbers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import Float32Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.extras import require
from nispcodec.core.progress import Listener, Progress, silent
from nispcodec.metrics.compare import Report, compare
from nispcodec.metrics.pictures import compare_pictures
from nispcodec.metrics.surface import frame_of
from nispcodec.model import NispModel
from nispcodec.render.camera import Camera, turntable
from nispcodec.render.difference import SCALE, close_ups, difference, heat
from nispcodec.render.fragments import Scene
from nispcodec.render.layout import layouts
from nispcodec.render.views import on_white, render_views, scene_of

VIEWS, CLOSE_UPS = 4, 2
STAGES = ("views", "close-ups", "UV layouts", "numbers")
LINE, FONT, INDENT = 22, 14, 6
BLACK, GRAY = (0, 0, 0), (110, 110, 110)


@dataclass(frozen=True)
class Sheet:
    """The finished page (h, w, 3) float32 in [0, 1], sRGB-encoded, and the numbers on it."""

    picture: Float32Array
    report: Report


def sheet(
    original: TexturedMesh,
    decoded: NispModel | TexturedMesh,
    size: int = 320,
    title: str = "",
    progress: Listener = silent,
) -> Sheet:
    """Original, decode and their difference from VIEWS sides, and CLOSE_UPS where they differ most.

    Every picture is `size` pixels wide. Both are drawn by the same camera, lamp and shader: a model
    is sphere-traced, a mesh is hit by rays. To their right are the UV layouts. On top stand the
    title and the numbers: PSNR and SSIM of the VIEWS; distance, UV and color of the decoded mesh
    as in `nispcodec.metrics.compare`. Raises MeshError for a mesh without a surface and for a
    texture that does not decode, NispError without the extra `render`.
    """
    require("scipy", "igl", "embreex", "skimage", extra="render", what_for="a sheet")
    frame = frame_of(original)
    scenes = scene_of(original, frame), scene_of(decoded, frame)
    _tell(progress, 0)
    around = _rows(scenes, turntable(VIEWS), size)
    _tell(progress, 1)
    rows = _rows(scenes, close_ups(scenes[0], turntable(VIEWS), around[2], CLOSE_UPS), size)
    _tell(progress, 2)
    rows = [[*first, *second] for first, second in zip(around, rows, strict=True)]
    if original.has_uv.any():
        plots = layouts(original, decoded, frame, size)
        rows = [[*row, plot] for row, plot in zip(rows, plots, strict=True)]
    _tell(progress, 3)
    report = _numbers(original, decoded, list(zip(*around[:2], strict=True)))
    pictures = [*rows[:2], [heat(each) for each in rows[2]]]
    return Sheet(_page(pictures, [title or original.name, _text(report)]), report)


def _tell(progress: Listener, stage: int) -> None:
    progress(Progress(stage=STAGES[stage], step=stage, steps=len(STAGES)))


def _rows(scenes: tuple[Scene, Scene], views: list[Camera], size: int) -> list[list[Float32Array]]:
    """Pictures of both on white, and their differences: three rows of one a view."""
    first, second = (
        [on_white(picture) for picture in render_views(scene, views, size)] for scene in scenes
    )
    return [first, second, [difference(*pair) for pair in zip(first, second, strict=True)]]


def _numbers(
    original: TexturedMesh,
    decoded: NispModel | TexturedMesh,
    pairs: list[tuple[Float32Array, Float32Array]],
) -> Report:
    each = [compare_pictures(*pair) for pair in pairs]
    means = {name: float(np.mean([one[name] for one in each])) for name in each[0]}
    if isinstance(decoded, NispModel):
        report = compare(original, decoded.to_mesh(), model=decoded)
    else:
        report = compare(original, decoded)
    return {"pictures": {**means}, **report}


def _text(report: Report) -> str:
    """The report's most telling numbers in a line."""
    pictures, distance = report["pictures"], report["geometry"]["larger"]
    parts = [f"pictures {pictures['psnr']:.1f} dB, SSIM {pictures['ssim']:.3f}"]
    if isinstance(distance, dict):
        parts.append(f"distance mean {distance['mean']:.1e}, p99 {distance['p99']:.1e}")
    uv = report.get("uv", {}).get("larger")
    if isinstance(uv, dict):
        parts.append(f"UV median {uv['median']:.1e}, mean {uv['mean']:.1e}")
    parts.append(f"color {report['color']['psnr']:.1f} dB")
    if "charts" in report:
        parts.append(f"charts {report['charts']['accuracy']:.3f}")
    return "   ".join(parts)


def _page(rows: list[list[Float32Array]], lines: list[str]) -> Float32Array:
    from PIL import Image, ImageDraw, ImageFont

    grid = np.concatenate([np.concatenate(row, axis=1) for row in rows], axis=0)
    top, height = LINE * len(lines), len(rows[0][0])
    text = Image.new("RGB", (grid.shape[1], top + len(grid)), "white")
    pen, font = ImageDraw.Draw(text), ImageFont.load_default(size=FONT)
    for number, line in enumerate(lines):
        pen.text((INDENT, number * LINE + 3), line, BLACK, font)
    names = ("original", "decoded", f"difference: white 0, black {SCALE:g} of the range and more")
    for number, name in enumerate(names):
        pen.text((INDENT, top + number * height + 3), name, GRAY, font)
    page = np.asarray(text, dtype=np.float32) / np.float32(255)
    page[top:] = np.minimum(page[top:], grid)
    return page
