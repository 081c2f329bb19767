"""The views of an asset that SRN and NeRF learn from, and those that nobody has seen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.paper.rays import box_of
from benchmarks.paper.unlit import unlit_mesh
from nispcodec.core.arrays import Float32Array, FloatArray
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import Frame
from nispcodec.render.camera import Camera, turntable
from nispcodec.render.views import on_white, render_views, scene_of

# Degrees: turned by so much, no two of many cameras come to stand above each other.
GOLDEN = 180 * (3 - 5**0.5)


@dataclass(frozen=True)
class ViewSet:
    """Pictures of one asset, unlit, on white, and where its surface can be.

    cameras, pictures  (v, size, size, 3) float32 in [0, 1], to learn from
    held_out, hidden   the same, to be judged by
    frame              of the asset
    box                (2, 3): around the asset, normalized frame
    """

    cameras: Sequence[Camera]
    pictures: Float32Array
    held_out: Sequence[Camera]
    hidden: Float32Array
    frame: Frame
    box: FloatArray


def view_set(mesh: TexturedMesh, count: int, held_out: int, size: int) -> ViewSet:
    """`count` views from all around, and `held_out` of a turntable, `size` pixels wide.

    Raises MeshError for a mesh without a surface and for a texture that does not decode.
    """
    scene = scene_of(unlit_mesh(mesh))
    cameras, others = all_around(count), turntable(held_out)
    seen, hidden = (
        np.stack([on_white(each) for each in render_views(scene, views, size)])
        for views in (cameras, others)
    )
    box = box_of(scene.frame.to_normalized(mesh.positions))
    return ViewSet(cameras, seen, others, hidden, scene.frame, box)


def all_around(count: int) -> list[Camera]:
    """Cameras spread evenly over the sphere, from the top down (Swinbank and Purser 2006)."""
    heights = 1 - (2 * np.arange(count) + 1) / count
    elevations = np.degrees(np.arcsin(heights))
    return [Camera(GOLDEN * i, float(elevation)) for i, elevation in enumerate(elevations)]
