from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from nispcodec.core.asset import Material, TexturedMesh, TextureMap
from nispcodec.core.errors import MeshError
from tests import tiny


def pair() -> TexturedMesh:
    """Two triangles, of which the first has UVs."""
    return TexturedMesh(
        positions=np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 5]], float),
        faces=np.array([[0, 1, 2], [0, 2, 3]], np.int32),
        uvs=np.array([[0, 0], [0.5, 0], [0.5, 0.5]]),
        uv_faces=np.array([[0, 1, 2], [-1, -1, -1]], np.int32),
        face_materials=np.zeros(2, np.int32),
    )


def test_corners_are_those_of_each_face_and_zeros_without_uv() -> None:
    mesh = pair()
    assert mesh.corners[1].tolist() == [[0, 0, 0], [1, 1, 0], [0, 1, 5]]
    assert mesh.has_uv.tolist() == [True, False]
    np.testing.assert_array_equal(mesh.corner_uvs, [mesh.uvs, np.zeros((3, 2))])


def test_geometry_alone_has_one_material_and_no_uv() -> None:
    mesh = TexturedMesh.geometry_only(pair().positions, pair().faces.astype(np.int64), "bare")
    assert (mesh.name, len(mesh.materials), mesh.uvs.shape) == ("bare", 1, (0, 2))
    assert mesh.faces.dtype == np.int32
    assert not mesh.has_uv.any()
    assert not mesh.corner_uvs.any()


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"positions": np.zeros((4, 2))}, r"positions: expected shape \(None, 3\) of float64"),
        ({"positions": np.zeros((4, 3), "f4")}, r"found shape \(4, 3\) of float32"),
        ({"positions": np.full((4, 3), np.nan)}, "positions: expected finite numbers, found NaN"),
        ({"uvs": np.full((3, 2), np.inf)}, "uvs: expected finite numbers, found NaN or infinity"),
        ({"faces": np.full((2, 3), 4, "i4")}, "faces: expected indices from 0 to 3, found 4 to 4"),
        ({"faces": np.full((2, 3), -1, "i4")}, "faces: expected indices from 0 to 3, found -1"),
        ({"uv_faces": np.full((2, 3), -2, "i4")}, "uv_faces: expected indices from -1 to 2"),
        ({"uv_faces": np.zeros((3, 3), "i4")}, r"uv_faces: expected shape \(2, 3\) of int32"),
        ({"face_materials": np.ones(2, "i4")}, "face_materials: expected indices from 0 to 0"),
        ({"face_materials": np.zeros(1, "i4")}, r"face_materials: expected shape \(2,\) of int32"),
    ],
)
def test_arrays_that_do_not_fit_are_refused(change: dict[str, Any], text: str) -> None:
    with pytest.raises(MeshError, match=text):
        replace(pair(), **change)


MESH = replace(
    TexturedMesh.geometry_only(np.eye(3), np.arange(3)[None], "m"),
    textures=(tiny.png(np.zeros((1, 1, 3), np.uint8)),),
)


@pytest.mark.parametrize(
    ("material", "said"),
    [
        (Material("a\tb"), "material 'a\\\\tb': expected a name without control characters"),
        (Material("\ud800"), "expected a name without control characters"),
        (Material("m", alpha_mode="fog"), "material 'm': alpha mode: expected one of opaque"),
        (Material("m", maps={"gloss": TextureMap(0)}), "slot: expected one of base_color"),
        (
            Material("m", maps={"normal": TextureMap(1)}),
            "normal: expected a texture below 1, found",
        ),
        (Material("m", maps={"normal": TextureMap(-1)}), "normal: expected a texture below 1"),
        (Material("m", maps={"normal": TextureMap(0, ("wrap", "clamp"))}), "wrap: expected one of"),
        (Material("m", maps={"normal": TextureMap(0, filter="cubic")}), "filter: expected one of"),
    ],
)
def test_materials_that_make_no_sense_are_refused(material: Any, said: str) -> None:
    with pytest.raises(MeshError, match=said):
        replace(MESH, materials=(material,))


def test_a_sound_material_is_taken() -> None:
    sound = Material(
        "m", alpha_mode="blend", maps={"occlusion": TextureMap(0, ("clamp", "mirror"))}
    )
    assert replace(MESH, materials=(sound,)).materials == (sound,)


def test_some_faces_keep_all_that_is_theirs() -> None:
    mesh = pair()
    creases = np.eye(len(mesh.faces), 3, dtype=np.bool_)
    chosen = np.arange(len(mesh.faces)) > 0
    some = replace(mesh, creases=creases).only(chosen)
    assert some.creases is not None
    np.testing.assert_array_equal(some.creases, creases[chosen])
    np.testing.assert_array_equal(some.corners, mesh.corners[chosen])
    np.testing.assert_array_equal(some.corner_uvs, mesh.corner_uvs[chosen])
    assert mesh.only(chosen).creases is None
