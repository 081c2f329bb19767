"""A dense ball that stands in a box, with a small box in it, and a dense sheet beside them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.core.asset import Material, TexturedMesh
from tests.geometry.shapes import cube, grid, soup, sphere

BALL, BOX, CARD, HIDDEN = range(4)


def mixed(rings: int = 20) -> TexturedMesh:
    """Bodies are told by their materials."""
    bodies = [
        sphere(rings),
        cube((-1.0, -1.0, -2.7), 2.0),
        grid(16) + np.array([2.5, 0.0, 0.0]),
        cube((-0.1, -0.1, 0.2), 0.2),
    ]
    mesh = soup(np.concatenate(bodies))
    of_material = np.repeat(np.arange(4), [len(body) for body in bodies])
    materials = tuple(Material(name) for name in ("ball", "box", "card", "hidden"))
    return replace(mesh, face_materials=of_material.astype(np.int32), materials=materials)
