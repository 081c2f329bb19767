"""Scenes of bodies that are copies of each other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.core.asset import Material, TexturedMesh
from nispcodec.core.mesh_part import Placement
from nispcodec.core.placing import placed_points
from tests.geometry import shapes

PLACES = (
    Placement(offset=(-0.4, -0.4, 0.0)),
    Placement((0.6, 0.0, 0.8, 0.0), (0.4, -0.4, 0.1), scale=0.5),
    Placement(offset=(0.4, 0.4, 0.0), mirrored=True),
    Placement((0.8, 0.0, 0.0, 0.6), (-0.4, 0.4, 0.0), uv_scale=(0.5, -1.0), uv_offset=(0.1, 0.9)),
)
"""Where copies stand: moved; turned and smaller; reflected; turned, with other UVs."""


def pebble(rings: int = 5) -> TexturedMesh:
    """A lump without any symmetry, in two charts of two materials."""
    corners = shapes.sphere(rings) * [0.3, 0.2, 0.12]
    corners[..., 2] += 0.1 * np.sin(6 * corners[..., 0] + 1) * np.cos(5 * corners[..., 1])
    below = shapes.sphere(rings)[..., 2].mean(axis=1) < 0
    uvs = corners[..., :2] * 0.5 + np.where(below, 0.7, 0.3)[:, None, None]
    mesh = shapes.soup(corners.round(9), uvs)
    return replace(mesh, face_materials=below.astype(np.int32))


def copied(mesh: TexturedMesh, places: tuple[Placement, ...] = PLACES) -> TexturedMesh:
    """A mesh at several places, the second one in other materials."""
    count, materials = len(mesh.faces), mesh.face_materials
    owned = [materials, materials + 2, *[materials] * (len(places) - 2)]
    corners = np.concatenate([_placed(mesh, place) for place in places])
    uvs = np.concatenate([_uvs(mesh, place) for place in places])
    soup = shapes.soup(corners, uvs)
    every = np.concatenate(owned[: len(places)])
    assert len(every) == count * len(places)
    return replace(soup, face_materials=every, materials=(Material("m"),) * 4)


def _placed(mesh: TexturedMesh, place: Placement) -> Float64Array:
    points = placed_points(place, mesh.positions)[mesh.faces]
    return points[:, ::-1] if place.mirrored else points


def _uvs(mesh: TexturedMesh, place: Placement) -> Float64Array:
    uvs = mesh.corner_uvs * place.uv_scale + place.uv_offset
    return uvs[:, ::-1] if place.mirrored else uvs
