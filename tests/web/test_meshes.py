"""Mesh parts in JavaScript: read and asked as by the library, extracted as they are."""

from __future__ import annotations

import json
from base64 import b64encode
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nispcodec.core.arrays import AnyArray
from nispcodec.core.connectivity import row_ids
from nispcodec.core.creases import fan_normals
from nispcodec.core.document import Document
from nispcodec.core.errors import FormatError
from nispcodec.core.mesh_part import MeshPart
from nispcodec.format import mesh, pack, unpack
from nispcodec.model import NispModel
from nispcodec.simplify.config import CopiesConfig
from nispcodec.simplify.copies import Copies
from nispcodec.simplify.halves import with_halves
from nispcodec.simplify.mirror import planes_of
from tests.format.mesh.parts import box, grid, part
from tests.simplify.mirrored import body, parts_of
from tests.web.mesh_documents import document as mesh_document
from tests.web.mesh_documents import documents
from tests.web.programs import HERE, answers, run_node
from tests.web.test_decoder import images

DOCUMENTS = documents()


def decoded(contents: list[bytes], folder: Path) -> list[Any]:
    path = folder / "contents.json"
    path.write_text(json.dumps([b64encode(each).decode() for each in contents]))
    found: list[Any] = json.loads(run_node(HERE / "meshes.mjs", path))
    return found


def same(made: MeshPart, found: dict[str, Any]) -> bool:
    """Whether JavaScript read the same part."""
    pairs: list[tuple[AnyArray, Any]] = [
        (made.positions, found["positions"]),
        (made.faces, found["faces"]),
        (made.uvs, found["uvs"]),
        (made.uv_faces, found["uvFaces"]),
        (made.face_charts, found["faceCharts"]),
        (made.chart_materials, found["chartMaterials"]),
        (made.chart_has_uv, found["chartHasUv"]),
        (made.creases, found["creases"]),
        (made.sheet, found["sheet"]),
        (np.array([made.step, *made.origin]), [found["step"], *found["origin"]]),
        (np.array([*made.uv_step, *made.uv_origin]), [*found["uvStep"], *found["uvOrigin"]]),
    ]
    return all(np.array_equal(one.ravel(), np.array(other)) for one, other in pairs)


def random_parts(count: int) -> list[MeshPart]:
    """Any faces over few vertices: edges of many faces, twice the same face, charts anywhere."""
    found = []
    for seed in range(count):
        rng = np.random.default_rng(seed)
        vertices = int(rng.integers(3, 30))
        faces = np.array([rng.permutation(vertices)[:3] for _ in range(rng.integers(1, 40))])
        charts = int(rng.integers(1, 4))
        face_charts = rng.integers(0, charts, len(faces)).astype(np.int32)
        has_uv = rng.random(charts) < 0.7
        uv_faces = np.where(has_uv[face_charts][:, None], faces, -1).astype(np.int32)
        made = part(
            rng.integers(0, 1 << int(rng.integers(0, 21)), (vertices, 3)),
            faces,
            uvs=rng.integers(0, 1 << int(rng.integers(0, 21)), (vertices, 2)).astype(np.int32),
            uv_faces=uv_faces,
            face_charts=face_charts,
            chart_materials=rng.integers(0, 300, charts).astype(np.int32),
            chart_has_uv=has_uv,
            sheet=rng.random(len(faces)) < rng.choice([0.0, 0.5, 1.0]),
        )
        found.append(made)
    return found


def test_random_parts_are_read_as_the_library_reads_them(tmp_path: Path) -> None:
    made = [box(), grid(9), grid(9, turned=True), *random_parts(60)]
    contents = [mesh.encode((each, box())) for each in made]
    for content, found in zip(contents, decoded(contents, tmp_path), strict=True):
        wanted = mesh.decode(content)
        assert len(found) == len(wanted) == 2
        assert all(same(one, other) for one, other in zip(wanted, found, strict=True))


def test_changed_bytes_are_refused_where_the_library_refuses_them(tmp_path: Path) -> None:
    rng = np.random.default_rng(5)
    contents = []
    for each in random_parts(30):
        whole = bytearray(mesh.encode((each,)))
        for _ in range(20):
            changed = whole.copy()
            changed[rng.integers(len(whole))] ^= int(rng.integers(1, 256))
            contents.append(bytes(changed[: rng.integers(len(whole) // 2, len(whole) + 1)]))
    refused = 0
    for content, found in zip(contents, decoded(contents, tmp_path), strict=True):
        try:
            wanted = mesh.decode(content)
        except FormatError:
            assert isinstance(found, dict)
            refused += 1
            continue
        assert all(same(one, other) for one, other in zip(wanted, found, strict=True))
    assert 0 < refused < len(contents)


def points() -> AnyArray:
    """Most of them near the middle, off everything by chance."""
    rng = np.random.default_rng(1)
    return np.concatenate([rng.uniform(-1.2, 1.2, (300, 3)), rng.normal(0, 0.4, (300, 3))])


@pytest.fixture(scope="module")
def asked(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """Answers of JavaScript by name of the document."""
    folder, requests = tmp_path_factory.mktemp("meshes"), []
    at = points().astype(np.float32).astype(float).tolist()
    for name, document in DOCUMENTS.items():
        path = folder / f"{name}.nisp"
        path.write_bytes(pack(document))
        request = {"path": str(path), "points": at, "images": images(document), "kernel": "wasm"}
        requests.append(request)
    return dict(zip(DOCUMENTS, answers(requests, folder), strict=True))


@pytest.mark.parametrize("name", DOCUMENTS)
def test_answers_are_those_of_the_library(name: str, asked: dict[str, Any]) -> None:
    model, found = NispModel(DOCUMENTS[name]), asked[name]
    at = points().astype(np.float32)
    assert "error" not in found, found
    assert np.abs(found["sdf"] - model.sdf(at, "normalized")).max() < 1e-5
    assert (np.array(found["sdf"]) < 0).any() or name == "sheets"
    assert np.array_equal(found["chart"], model.charts(at, "normalized"))
    uvs = np.reshape(found["uv"], (-1, 2))
    assert np.abs(uvs - model.uv(at, "normalized")).max() < 1e-5
    colors = np.reshape(found["color"], (-1, 4))
    assert np.abs(colors - model.color(at, "normalized")).max() < 0.01
    normals = model.normals(at, "normalized")
    gradients = np.reshape(found["gradient"], (-1, 3))
    units = gradients / np.linalg.norm(gradients, axis=1, keepdims=True)
    assert np.abs(units - normals).max() < 1e-3


def corner_rows(positions: AnyArray, uvs: AnyArray, keys: AnyArray) -> AnyArray:
    """(m, 16) what each triangle has, from its lowest corner on, in order of rows."""
    corners = np.concatenate([positions, uvs], axis=2)
    first = [min(range(3), key=lambda i: tuple(np.round(row[i], 4))) for row in corners]
    turned = np.array([np.roll(row, -at, axis=0) for row, at in zip(corners, first, strict=True)])
    rows = np.column_stack([turned.reshape(len(turned), -1), keys])
    return rows[np.lexsort(np.round(rows, 4).T[::-1])]


@pytest.mark.parametrize("name", [name for name in DOCUMENTS if name != "mixed"])
def test_triangles_are_handed_over_as_they_are(name: str, tmp_path: Path) -> None:
    document = DOCUMENTS[name]
    (tmp_path / "model.nisp").write_bytes(pack(document))
    found = json.loads(run_node(HERE / "meshes.mjs", "--extract", tmp_path / "model.nisp"))[0]
    indices = np.reshape(found["indices"], (-1, 3))
    materials = np.concatenate(
        [np.full(each["count"] // 3, each["material"]) for each in found["groups"]]
    )
    ours = corner_rows(
        np.reshape(found["positions"], (-1, 3))[indices],
        np.reshape(found["uvs"], (-1, 2))[indices],
        materials,
    )
    wanted = NispModel(document).to_mesh()
    padded = np.vstack([wanted.uvs, np.zeros((1, 2))])
    theirs = corner_rows(
        document.frame.to_normalized(wanted.positions)[wanted.faces],
        padded[wanted.uv_faces],
        wanted.face_materials,
    )
    assert ours.shape == theirs.shape
    assert np.abs(ours - theirs).max() < 1e-5
    normals = np.reshape(found["normals"], (-1, 3))
    assert np.abs(np.linalg.norm(normals, axis=1) - 1).max() < 1e-5
    assert set(found["charts"]) <= set(range(len(document.chart_materials)))


def test_normals_are_smooth_between_creases_whatever_the_triangles(tmp_path: Path) -> None:
    made = box()
    rim = {0, 1, 2, 3}  # The side at x = 0, whose four edges are creases.
    edges = np.stack([made.faces, np.roll(made.faces, -1, axis=1)], axis=2)
    diagonal = (np.array([[0, 3]]) == np.sort(edges, axis=2)).all(axis=2)
    creases = np.isin(edges, list(rim)).all(axis=2) & ~diagonal
    broken = replace(made, creases=creases, step=0.05)
    (tmp_path / "model.nisp").write_bytes(pack(mesh_document(broken)))
    found = json.loads(run_node(HERE / "meshes.mjs", "--extract", tmp_path / "model.nisp"))[0]
    positions = np.reshape(found["positions"], (-1, 3))
    wide, high, deep = np.ptp(positions, axis=0)
    areas = np.array([high * deep, wide * deep, wide * high])
    outwards = areas * np.sign(positions - (positions.min(axis=0) + positions.max(axis=0)) / 2)
    for normal, sides in zip(np.reshape(found["normals"], (-1, 3)), outwards, strict=True):
        ways = [sides] if sides[0] > 0 else [sides * (1, 0, 0), sides * (0, 1, 1)]
        assert min(np.abs(normal - way / np.linalg.norm(way)).max() for way in ways) < 1e-6
    assert len(positions) == 4 + 2 * 4


def test_shading_is_the_library_s_whatever_meets_in_an_edge(tmp_path: Path) -> None:
    shapes = [two_walls(), *(one_material(each) for each in random_parts(12))]
    paths = [tmp_path / f"{number}.nisp" for number in range(len(shapes))]
    for made, path in zip(shapes, paths, strict=True):
        path.write_bytes(pack(mesh_document(replace(made, step=0.05))))
    for found, path in zip(
        json.loads(run_node(HERE / "meshes.mjs", "--extract", *paths)), paths, strict=True
    ):
        held = unpack(path.read_bytes()).meshes[0]
        order = np.argsort(held.chart_has_uv[held.face_charts], kind="stable")
        corners = held.normalized()[held.faces]
        rows, fans = fan_normals(held.faces.astype(np.int64), corners, held.shading_breaks)
        ours = np.reshape(found["normals"], (-1, 3))[np.reshape(found["indices"], (-1, 3))]
        assert np.abs(ours - rows[fans[order]]).max() < 1e-4


def test_shading_goes_on_over_borders_that_meet(tmp_path: Path) -> None:
    copies = with_halves(Copies.none(body()), planes_of(np.zeros(3)), CopiesConfig(fewest=20))
    assert copies is not None
    halves = mesh_document(*parts_of(copies))
    (tmp_path / "model.nisp").write_bytes(pack(halves))
    found = json.loads(run_node(HERE / "meshes.mjs", "--extract", tmp_path / "model.nisp"))[0]
    mesh = NispModel(halves).to_mesh()
    assert mesh.creases is not None
    rows, fans = fan_normals(row_ids(mesh.positions)[mesh.faces], mesh.corners, mesh.creases)
    ours = np.reshape(found["normals"], (-1, 3))[np.reshape(found["indices"], (-1, 3))]
    assert np.abs(ours - rows[fans]).max() < 1e-4


def two_walls() -> MeshPart:
    """An upright wall and a floor that meet in a point alone, without creases."""
    floor = [[2, 2, 0], [4, 2, 0], [4, 4, 0], [2, 4, 0]]
    wall = [[2, 2, 2], [2, 0, 2], [2, 0, 0]]
    faces = np.array([[0, 1, 2], [0, 2, 3], [0, 4, 5], [0, 5, 6]])
    return part(np.array(floor + wall), faces)


def one_material(made: MeshPart) -> MeshPart:
    return replace(made, chart_materials=np.zeros_like(made.chart_materials))


def test_a_mixed_file_has_both_surfaces(tmp_path: Path) -> None:
    document: Document = DOCUMENTS["mixed"]
    (tmp_path / "model.nisp").write_bytes(pack(document))
    found = json.loads(run_node(HERE / "meshes.mjs", "--extract", tmp_path / "model.nisp"))[0]
    counts = dict.fromkeys((True, False), 0)
    for each in found["groups"]:
        counts[each["fitted"]] += each["count"] // 3
    assert counts[False] == sum(len(each.faces) * 2 for each in document.meshes)
    assert counts[True] > 100
    assert max(found["indices"]) == len(found["charts"]) - 1
