"""Triangles that are mirror images of each other are held once, where all faces are kept."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree

from nispcodec.core.arrays import Float64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.connectivity import edge_ids, row_ids
from nispcodec.simplify.config import CopiesConfig
from nispcodec.simplify.copies import Copies
from nispcodec.simplify.halves import with_halves
from nispcodec.simplify.mirror import planes_of
from nispcodec.simplify.triangles import joined
from tests.geometry import shapes
from tests.simplify.meshes import simplifier, triangles_of
from tests.simplify.mirrored import BITS, PLANES, body, halved, model_of, parts_of


def sizes(copies: Copies | None) -> list[tuple[int, int]]:
    """The faces of each group, and its placements."""
    assert copies is not None
    return [(len(home), len(group.placements)) for group, home in copies.homes]


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("at", [0.0, 0.123])
def test_one_half_stands_for_both(axis: int, at: float) -> None:
    whole = body(axis, at)
    copies = halved(whole, *planes_of(np.roll([at, 0.0, 0.0], axis)))
    assert sizes(copies) == [(len(whole) // 2, 2)]
    assert copies is not None
    decoded = model_of(parts_of(copies)).to_mesh()
    plain = model_of(parts_of(Copies.none(whole))).to_mesh()
    step = float(np.ptp(whole.positions, axis=0).max()) / (2**BITS - 1)
    apart, _ = cKDTree(_rows(decoded)).query(_rows(plain))
    assert len(decoded.faces) == len(plain.faces)
    assert apart.max() < 4 * step
    assert is_closed(decoded.positions, decoded.faces)


def _rows(mesh: TexturedMesh) -> Float64Array:
    """(3 m, 8): the corners of all faces, with their UVs and the middles of the faces."""
    middles = np.repeat(mesh.corners.mean(axis=1), 3, axis=0)
    return np.concatenate([mesh.corners.reshape(-1, 3), mesh.corner_uvs.reshape(-1, 2), middles], 1)


def is_closed(positions: Float64Array, faces: np.ndarray) -> bool:
    edges, ways = edge_ids(row_ids(positions)[faces])
    return bool((np.bincount(edges) == 2).all() and (np.bincount(edges, ways) == 0).all())


def test_inside_and_outside_are_those_of_the_whole() -> None:
    whole = body()
    copies = halved(whole)
    assert copies is not None
    points = np.random.default_rng(0).uniform(-0.7, 0.7, (2000, 3))
    ours = model_of(parts_of(copies)).sdf(points)
    plain = model_of(parts_of(Copies.none(whole))).sdf(points)
    assert np.abs(ours - plain).max() < 1e-3
    assert (ours < 0).any()


def test_what_has_no_image_is_a_part_of_its_own_and_meets_the_halves() -> None:
    whole = body()
    positions = whole.positions.copy()
    positions[int(positions[:, 0].argmax())] += 0.05
    dented = replace(whole, positions=positions)
    copies = halved(dented)
    (rest, once), (half, twice) = sizes(copies)
    assert (once, twice) == (1, 2)
    assert 2 <= rest < 20
    assert rest + 2 * half == len(whole)
    assert copies is not None
    decoded = model_of(parts_of(copies)).to_mesh()
    assert is_closed(decoded.positions, decoded.faces)


def test_uvs_may_be_reflected_and_shifted_alike_everywhere() -> None:
    whole = body()
    side = whole.corners.mean(axis=1)[:, 0] > 0
    uvs = whole.corner_uvs.copy()
    uvs[side] = uvs[side] * [-1, 1] + [0.9, 0.05]
    turned = triangles_of(shapes.soup(whole.corners, uvs))
    copies = halved(turned)
    assert sizes(copies) == [(len(whole) // 2, 2)]
    assert copies is not None
    placement = copies.groups[0].placements[1]
    assert placement.uv_scale == (-1.0, 1.0)
    assert placement.uv_offset == pytest.approx((0.9, -0.05))


def test_other_uvs_materials_and_windings_are_no_images() -> None:
    whole = body()
    side = whole.corners.mean(axis=1)[:, 0] > 0
    uvs = whole.corner_uvs.copy()
    uvs[side] *= 0.5
    assert halved(triangles_of(shapes.soup(whole.corners, uvs))) is None
    assert halved(replace(whole, materials=side.astype(np.int32))) is None
    faces, uv_faces = whole.faces.copy(), whole.uv_faces.copy()
    faces[side], uv_faces[side] = faces[side][:, ::-1], uv_faces[side][:, ::-1]
    assert halved(replace(whole, faces=faces, uv_faces=uv_faces)) is None


def test_few_faces_are_not_worth_a_part() -> None:
    whole = body()
    assert with_halves(Copies.none(whole), PLANES, CopiesConfig(fewest=len(whole))) is None


def test_without_uvs_geometry_alone_decides() -> None:
    bare = replace(body(), uvs=np.zeros((0, 2)), uv_faces=np.full_like(body().uv_faces, -1))
    assert sizes(halved(bare)) == [(len(bare) // 2, 2)]


def test_bodies_that_have_copies_stay_what_they_are() -> None:
    small = replace(body(), positions=body().positions * 0.3)
    far = replace(small, positions=small.positions + np.array([0.0, 0.8, 0.0]))
    both = joined(small, replace(far, patches=far.patches + small.patches.max() + 1))
    assert sizes(halved(both)) == [(len(small), 2)]


def test_all_faces_take_fewer_bytes_and_fewer_faces_are_as_before() -> None:
    whole = body()
    plain, ours = simplifier(whole), replace(simplifier(whole), planes=PLANES)
    every, few = len(whole), len(whole) // 2
    assert ours.candidate(every, 11, 11).size < 0.75 * plain.candidate(every, 11, 11).size
    assert ours.candidate(few, 11, 11).size == plain.candidate(few, 11, 11).size
    near, usual = (each.candidate(every, 11, 11).errors for each in (ours, plain))
    assert near.distance < 1.3 * usual.distance
