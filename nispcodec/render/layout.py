"""UV layouts as pictures: where points of the surface lie in the texture."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nispcodec.asset import TexturedMesh
from nispcodec.decode.model import NispModel
from nispcodec.document import Frame
from nispcodec.metrics.surface import Surface, SurfacePoints
from nispcodec.metrics.uv import uv_at
from nispcodec.render.fragments import Floats

POINTS = 200_000


def layouts(
    original: TexturedMesh, decoded: NispModel | TexturedMesh, frame: Frame, size: int
) -> tuple[Floats, Floats]:
    """The UV layouts of both (size, size, 3), of the same points of the original surface.

    A point is drawn in both in the colour of its original UV: what is misplaced stands out.
    """
    surface = Surface.of(original, frame)
    points = surface.sample(POINTS, np.random.default_rng(0))
    points = points[original.has_uv[points.faces]]
    theirs = uv_at(surface, points)
    ours = _decoded_uvs(decoded, frame, points)
    colors = np.column_stack([theirs % 1, np.full(len(theirs), 0.5)]).astype(np.float32)
    low, span = _window(theirs)
    first, second = (_plot((uvs - low) / span, colors, size) for uvs in (theirs, ours))
    return first, second


def _decoded_uvs(
    decoded: NispModel | TexturedMesh, frame: Frame, points: SurfacePoints
) -> NDArray[np.floating]:
    if isinstance(decoded, NispModel):
        return decoded.uv(frame.to_world(points.positions))
    surface = Surface.of(decoded, frame)
    return uv_at(surface, surface.closest(points.positions))


def _window(uvs: NDArray[np.floating]) -> tuple[NDArray[np.floating], float]:
    """Lower left corner (2,) and width of the square that is shown: [0, 1]^2, or all there is."""
    low = np.minimum(uvs.min(axis=0, initial=0), 0)
    return low, float(max(1.0, (uvs - low).max(initial=1)))


def _plot(places: NDArray[np.floating], colors: Floats, size: int) -> Floats:
    picture = np.ones((size, size, 3), np.float32)
    cells = np.floor(places * size).astype(np.int64)
    inside = ((cells >= 0) & (cells < size)).all(axis=1)
    columns, rows = cells[inside].T
    picture[size - 1 - rows, columns] = colors[inside]
    return picture
