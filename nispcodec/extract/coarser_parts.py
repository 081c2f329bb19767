"""Mesh parts with fewer triangles, as the encoder simplifies them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import Frame
from nispcodec.core.extras import require
from nispcodec.extract.config import LevelConfig

if TYPE_CHECKING:
    from nispcodec.simplify.triangles import Triangles


def coarser(
    mesh: TexturedMesh, frame: Frame, counts: Iterable[int], config: LevelConfig
) -> Iterator[TexturedMesh]:
    """The mesh (world frame) with about so many faces, for each count; more where it is off far.

    Bodies smaller than the error go, edges of charts and creases stay. Raises NispError without the
    packages that simplify.
    """
    require("meshoptimizer", "igl", "scipy", extra="encode", what_for="simplifying triangles")
    from nispcodec.simplify.config import CollapseConfig, FitConfig
    from nispcodec.simplify.simplify import simplified
    from nispcodec.simplify.source import Source
    from nispcodec.simplify.triangles import Triangles

    source = Source(Triangles.of(mesh, frame))
    collapse = CollapseConfig(uv_weight=config.uv_weight, error=config.error)
    fit = FitConfig(reach=config.reach)
    for count in counts:
        yield _dressed(simplified(source, count, collapse, fit), mesh, frame)


def _dressed(triangles: Triangles, mesh: TexturedMesh, frame: Frame) -> TexturedMesh:
    """Triangles in the world frame, with the materials and textures of the mesh."""
    return replace(
        mesh,
        positions=frame.to_world(triangles.positions),
        faces=triangles.faces.astype(np.int32),
        uvs=triangles.uvs,
        uv_faces=triangles.uv_faces.astype(np.int32),
        face_materials=triangles.materials,
        creases=triangles.creases,
    )
