"""Small documents with mesh parts: alone, in copies, as sheets, beside a field."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

import nispcodec
from nispcodec.core.document import Document, Frame
from nispcodec.core.mesh_part import MeshPart, Placement
from nispcodec.encode.config import EncodeConfig
from nispcodec.format import pack, unpack
from tests import tiny
from tests.geometry.shapes import box_asset
from tests.infer import parts

TURNED = (
    Placement(),
    Placement(
        rotation=(0.6, 0.0, 0.8, 0.0),
        offset=(0.1, -0.4, 0.2),
        scale=0.5,
        mirrored=True,
        uv_scale=(0.5, 2.0),
        uv_offset=(0.25, 0.0),
        materials=np.array([1, 0], np.int32),
    ),
)


def copied() -> MeshPart:
    """A cube of two charts in two copies, the second smaller, mirrored, turned and repainted."""
    return parts.part_of(parts.cube(0.7, (0.2, 0.1, 0.3)), charts=2, placements=TURNED)


def document(*meshes: MeshPart, fitted: bool = False) -> Document:
    """A document of these meshes as a file keeps them, with a field on request."""
    whole = tiny.document(tiny.octahedron(0.5), frame=Frame((1.0, 2.0, 3.0), 2.0))
    return unpack(pack(replace(whole, field=whole.field if fitted else None, meshes=meshes)))


def documents() -> dict[str, Document]:
    """By name."""
    rng = np.random.default_rng(3)
    soup = parts.soup(60)
    return {
        "copies": document(copied()),
        "sheets": document(parts.part_of(soup, sheet=rng.random(60) < 0.5, charts=2)),
        "overlapping": document(
            parts.part_of(parts.cube(0.9, (-0.2, 0.1, 0))),
            parts.part_of(parts.cube(0.8, (0.5, 0, 0))),
        ),
        "mixed": document(copied(), fitted=True),
        "encoded": encoded(),
    }


@cache
def encoded() -> Document:
    """A box, as an encoder holds it that was told to take triangles."""
    model = nispcodec.encode(box_asset(), EncodeConfig(geometry="mesh"))
    return unpack(pack(model.document))
