"""Copies are found, and nothing that is none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from nispcodec.core.asset import TexturedMesh
from nispcodec.core.mesh_part import Placement
from nispcodec.simplify.config import CopiesConfig
from nispcodec.simplify.copies import Copies
from nispcodec.simplify.copy_search import copies_of
from tests.simplify.meshes import ball, triangles_of
from tests.simplify.scenes import PLACES, copied, pebble

CONFIG = CopiesConfig()
STONE = pebble()
MOVED = (Placement(), Placement(offset=(0.0, 0.9, 0.0)))


def found(mesh: TexturedMesh, config: CopiesConfig = CONFIG) -> Copies:
    return copies_of(triangles_of(mesh), config)


def count(copies: Copies) -> list[int]:
    """How many placements each group has."""
    return [len(group.placements) for group in copies.groups]


def second(mesh: TexturedMesh, shifts: np.ndarray) -> TexturedMesh:
    """A mesh whose second half of corners is shifted by (n, 3)."""
    positions = mesh.positions.copy()
    positions[len(positions) // 2 :] += shifts
    return replace(mesh, positions=positions)


def test_turned_scaled_mirrored_and_with_other_uvs_and_materials() -> None:
    copies = found(copied(STONE))
    assert count(copies) == [len(PLACES)]
    assert len(copies.triangles) == len(STONE.faces)
    placements = copies.groups[0].placements
    assert sorted(round(each.scale, 6) for each in placements) == [0.5, 1, 1, 1]
    assert sum(each.mirrored for each in placements) == 1
    scales = {tuple(np.round(each.uv_scale, 9).tolist()) for each in placements}
    assert scales == {(1.0, 1.0), (0.5, -1.0)}
    smaller = next(number for number, each in enumerate(placements) if each.scale < 0.9)
    own = {
        number: table
        for number, table in enumerate(copies.groups[0].materials)
        if table is not None
    }
    assert {number: sorted(table) for number, table in own.items()} == {smaller: [2, 3]}


def test_the_largest_is_held() -> None:
    copies = found(copied(STONE, (replace(PLACES[0], scale=0.5), *PLACES[1:])))
    assert max(each.scale for each in copies.groups[0].placements) == 1
    assert np.ptp(copies.triangles.positions, axis=0).max() > 0.55


def test_a_copy_that_differs_by_more_than_the_tolerance_is_none() -> None:
    pair = copied(STONE, MOVED)
    half = len(pair.positions) // 2
    bulge = np.zeros((half, 3))
    top = pair.positions[half:][:, 2] == pair.positions[half:][:, 2].max()
    for height, expected in ((5 * CONFIG.tolerance, [1]), (0.5 * CONFIG.tolerance, [2])):
        bulge[top, 2] = height
        assert count(found(second(pair, bulge))) == expected


@pytest.mark.parametrize("axes", [(1.0, 1.0, 1.05), (1.0, -1.0, 1.0)])
def test_stretched_or_inside_out_is_no_copy(axes: tuple[float, float, float]) -> None:
    pair = copied(STONE, MOVED)
    half = len(pair.positions) // 2
    own = pair.positions[half:] - MOVED[1].offset
    copies = found(second(pair, own * (np.array(axes) - 1)))
    assert count(copies) == [1]


def test_uvs_that_no_scale_and_shift_explain_are_no_copy() -> None:
    pair = copied(STONE, MOVED)
    uvs = pair.uvs.copy()
    half = len(uvs) // 2
    uvs[half:] = uvs[half:, ::-1]
    assert count(found(replace(pair, uvs=uvs))) == [1]


def test_a_patch_in_two_materials_is_no_copy() -> None:
    pair = copied(STONE, MOVED)
    materials = pair.face_materials.copy()
    materials[len(materials) // 2 + 3] = 3
    assert count(found(replace(pair, face_materials=materials))) == [1]


def test_without_copies_all_stays_as_it_is() -> None:
    triangles = ball()
    copies = copies_of(triangles, CONFIG)
    assert copies.triangles is triangles
    assert count(copies) == [1]


def test_bodies_of_few_faces_are_not_worth_a_placement() -> None:
    config = replace(CONFIG, fewest=len(STONE.faces) + 1)
    assert count(found(copied(STONE), config)) == [1]


def test_what_has_no_copy_is_a_group_of_its_own() -> None:
    stones = copied(STONE, (*MOVED, Placement(offset=(0.9, 0.0, 0.0))))
    last = 2 * len(STONE.faces) * 3
    positions = stones.positions.copy()
    positions[last:, 2] *= 1.5
    copies = found(replace(stones, positions=positions))
    assert count(copies) == [1, 2]
    assert len(copies.triangles) == 2 * len(STONE.faces)
    assert copies.groups[0].patches.stop == copies.groups[1].patches.start


def test_faces_that_begin_with_another_corner_are_the_same() -> None:
    pair = copied(STONE, MOVED)
    half = len(pair.faces) // 2
    faces, uv_faces = pair.faces.copy(), pair.uv_faces.copy()
    faces[half:], uv_faces[half:] = faces[half:][:, [1, 2, 0]], uv_faces[half:][:, [1, 2, 0]]
    assert count(found(replace(pair, faces=faces, uv_faces=uv_faces))) == [2]


def test_what_is_hidden_of_one_copy_alone_does_no_harm() -> None:
    triangles = triangles_of(copied(STONE))
    kept = np.ones(len(triangles), np.bool_)
    kept[:7] = kept[-9:] = False
    copies = copies_of(triangles, CONFIG, kept)
    assert count(copies) == [4]
    assert len(copies.triangles) == len(STONE.faces)
    assert copies.covered.all()


def test_what_is_hidden_of_every_copy_is_not_held() -> None:
    triangles = triangles_of(copied(STONE))
    faces = len(STONE.faces)
    hidden = np.tile(np.arange(faces) < 7, 4)
    # The third one is a reflection of the same faces in the same order.
    copies = copies_of(triangles, CONFIG, ~hidden)
    assert len(copies.triangles) == faces - 7
    assert (copies.covered == ~hidden).all()


def test_halves_that_lack_each_others_faces_stay_two() -> None:
    triangles = triangles_of(copied(STONE, MOVED))
    half = np.arange(len(STONE.faces)) < len(STONE.faces) // 2
    kept = np.concatenate([half, ~half])
    copies = copies_of(triangles, CONFIG, kept)
    assert count(copies) == [1]
    assert (copies.covered == kept).all()
    assert len(copies.triangles) == kept.sum()
