"""Tangents as normal maps want them: along u, at right angles to normals, on the side of v."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.core.asset import TextureMap
from nispcodec.io.write.gltf_tree import gltf_tree
from nispcodec.io.write.tangents import tangents, without_mirrors
from nispcodec.io.write.vertices import Vertices, groups, shading_normals, split_vertices
from nispcodec.model import NispModel
from tests import tiny


def square(uvs: list[list[float]]) -> Vertices:
    """Two faces in the plane z = 0 that look up, corners (0, 0), (1, 0), (1, 1), (0, 1)."""
    return Vertices(
        positions=np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]),
        uvs=np.array(uvs, np.float32),
        normals=np.tile(np.array([0, 0, 1], np.float32), (4, 1)),
        faces=np.array([[0, 1, 2], [0, 2, 3]], np.uint32),
        sources=np.arange(4),
    )


def test_tangents_go_where_u_grows_and_sides_where_v_does() -> None:
    plain = square([[0, 0], [1, 0], [1, 1], [0, 1]])
    np.testing.assert_allclose(tangents(plain), np.tile([1, 0, 0, 1], (4, 1)), atol=1e-6)
    turned = square([[0, 0], [0, 1], [-1, 1], [-1, 0]])
    np.testing.assert_allclose(tangents(turned), np.tile([0, -1, 0, 1], (4, 1)), atol=1e-6)
    mirrored = square([[0, 0], [-1, 0], [-1, 1], [0, 1]])
    np.testing.assert_allclose(tangents(mirrored), np.tile([-1, 0, 0, -1], (4, 1)), atol=1e-6)


def test_where_mirrored_faces_meet_others_vertices_are_double() -> None:
    folded = square([[0, 0], [1, 0], [1, 1], [2, 0]])
    assert without_mirrors(square([[0, 0], [1, 0], [1, 1], [0, 1]])).faces.max() == 3
    split = without_mirrors(folded)
    assert len(split.positions) == 6
    assert sorted(tangents(split)[:, 3].tolist()) == [-1, -1, -1, 1, 1, 1]
    for name in ("positions", "uvs", "normals"):
        before, after = getattr(folded, name), getattr(split, name)
        np.testing.assert_array_equal(after[split.faces], before[folded.faces])


def test_where_no_uv_grows_there_is_a_tangent_all_the_same() -> None:
    flat = tangents(square([[0.5, 0.5]] * 4))
    np.testing.assert_allclose(np.linalg.norm(flat[:, :3], axis=1), 1, atol=1e-6)
    np.testing.assert_allclose(flat[:, 2], 0, atol=1e-6)


def test_tangents_of_a_decode_are_unit_and_square_to_normals() -> None:
    mesh = NispModel(tiny.document()).to_mesh(32)
    for _, _, faces in groups(mesh):
        vertices = without_mirrors(split_vertices(mesh, faces, shading_normals(mesh)))
        found = tangents(vertices)
        np.testing.assert_allclose(np.linalg.norm(found[:, :3], axis=1), 1, atol=1e-5)
        np.testing.assert_allclose((found[:, :3] * vertices.normals).sum(axis=1), 0, atol=1e-5)
        assert set(np.unique(found[:, 3])) <= {-1.0, 1.0}


def test_gltf_has_tangents_where_there_is_a_normal_map_and_uvs() -> None:
    mesh = NispModel(tiny.document()).to_mesh(16)
    maps = {"base_color": TextureMap(0), "normal": TextureMap(0)}
    bumpy = replace(mesh, materials=(replace(mesh.materials[0], maps=maps), mesh.materials[1]))
    bare = replace(bumpy, uv_faces=np.full_like(mesh.uv_faces, -1))
    have = {
        name: [
            "TANGENT" in each["attributes"]
            for each in gltf_tree(made)[0]["meshes"][0]["primitives"]
        ]
        for name, made in (("plain", mesh), ("bumpy", bumpy), ("bare", bare))
    }
    assert have == {"plain": [False, False], "bumpy": [True, False], "bare": [False, False]}
