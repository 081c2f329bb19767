from __future__ import annotations

import io

import numpy as np
import PIL.Image
import pytest

from nispcodec.core.arrays import Float64Array, Int64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.geometry.charts import split_charts
from nispcodec.geometry.welding import welded
from nispcodec.io.cleanup import clean
from nispcodec.procedural.mug import sample_asset


@pytest.fixture(scope="module")
def mug() -> TexturedMesh:
    return sample_asset()


def test_it_is_what_the_readme_promises(mug: TexturedMesh) -> None:
    assert 5_000 <= len(mug.faces) <= 10_000
    assert len(split_charts(mug, welded(mug))) == 7
    assert [material.name for material in mug.materials] == ["glaze", "wood"]
    assert "normal" in mug.materials[1].maps
    assert mug.has_uv.all()


def test_it_needs_no_cleaning(mug: TexturedMesh) -> None:
    assert clean(mug, "mug").warnings == ()


def test_bodies_are_closed_and_face_outwards(mug: TexturedMesh) -> None:
    faces = mug.faces.astype(np.int64)
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    there, back = ({tuple(edge) for edge in way} for way in (edges, edges[:, ::-1]))
    assert there == back
    assert len(there) == len(edges)
    a, b, c = np.moveaxis(mug.corners, 1, 0)
    volumes = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6
    charts = split_charts(mug, welded(mug)).face_charts
    for body in ([0, 1, 2, 3], [4], [5, 6]):
        assert volumes[np.isin(charts, body)].sum() > 1


def test_no_two_faces_share_a_texel(mug: TexturedMesh) -> None:
    a, b, c = np.moveaxis(mug.corner_uvs, 1, 0)
    u, v = b - a, c - a
    areas = (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2
    assert (areas > 0).all()
    assert mug.uvs.min() >= 0
    assert mug.uvs.max() <= 1
    for material in (0, 1):
        covered = _coverage(mug.corner_uvs[mug.face_materials == material])
        assert covered.max() == 1
        assert covered.mean() > 0.4


def _coverage(triangles: Float64Array, size: int = 256) -> Int64Array:
    """How many triangles hold each texel center; centers are set off the triangles' edges."""
    count = np.zeros((size, size), dtype=int)
    for triangle in triangles * size - (0.5123, 0.4877):
        low, high = np.floor(triangle.min(axis=0)).astype(int), np.ceil(triangle.max(axis=0))
        x, y = np.meshgrid(np.arange(low[0], high[0] + 1), np.arange(low[1], high[1] + 1))
        inside = np.ones(x.shape, dtype=bool)
        for first, second in zip(triangle, np.roll(triangle, -1, axis=0), strict=True):
            edge = second - first
            inside &= edge[0] * (y - first[1]) - edge[1] * (x - first[0]) > 1e-9
        np.add.at(count, (y[inside].astype(int), x[inside].astype(int)), 1)
    return count


def test_textures_are_pngs_of_512_and_always_the_same(mug: TexturedMesh) -> None:
    assert [texture.data for texture in sample_asset().textures] == [
        texture.data for texture in mug.textures
    ]
    for texture in mug.textures:
        opened = PIL.Image.open(io.BytesIO(texture.data))
        assert (opened.format, opened.size) == ("PNG", (512, 512))


def test_the_normal_map_holds_unit_vectors_that_point_out(mug: TexturedMesh) -> None:
    normals = mug.textures[mug.materials[1].maps["normal"].texture]
    vectors = np.asarray(PIL.Image.open(io.BytesIO(normals.data))) / 127.5 - 1
    np.testing.assert_allclose(np.linalg.norm(vectors, axis=2), 1, atol=0.02)
    assert vectors[..., 2].min() > 0.3
