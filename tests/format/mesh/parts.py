"""Mesh parts for tests: known shapes, random ones of every kind, and how to compare two."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np
from hypothesis import strategies as st

from nispcodec.core.arrays import AnyArray, IntArray
from nispcodec.core.mesh_part import MeshPart, Placement


def part(positions: AnyArray, faces: AnyArray, **other: Any) -> MeshPart:
    """A part of one chart without UVs, or with what else is given."""
    count = len(faces)
    fields: dict[str, Any] = {
        "uvs": np.zeros((0, 2), np.int32),
        "uv_faces": np.full((count, 3), -1, np.int32),
        "face_charts": np.zeros(count, np.int32),
        "chart_materials": np.zeros(1, np.int32),
        "chart_has_uv": np.zeros(1, np.bool_),
        "creases": np.zeros((count, 3), np.bool_),
        "sheet": np.zeros(count, np.bool_),
        "step": 0.25,
    } | other
    return MeshPart(np.asarray(positions, np.int32), np.asarray(faces, np.int32), **fields)


def grid(side: int = 4, turned: bool = False) -> MeshPart:
    """A square sheet of side x side cells in the plane z = 1, one chart with UVs like a map's."""
    line = np.arange(side + 1)
    x, y = (each.ravel() for each in np.meshgrid(line, line))
    first = np.array([row * (side + 1) + at for row in range(side) for at in range(side)])
    a, b, c, d = first, first + 1, first + side + 2, first + side + 1
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    uvs = np.stack([30 * y, 30 * x] if turned else [30 * x, 30 * y], axis=1).astype(np.int32)
    return part(
        np.stack([10 * x, 10 * y, 0 * x + 1], axis=1),
        faces,
        uvs=uvs,
        uv_faces=faces.astype(np.int32),
        chart_has_uv=np.ones(1, np.bool_),
        sheet=np.ones(len(faces), np.bool_),
    )


def box(**other: Any) -> MeshPart:
    """A closed box, one chart without UVs."""
    corners = np.array([[x, y, z] for x in (0, 9) for y in (0, 7) for z in (0, 5)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [tri for a, b, c, d in quads for tri in ((a, b, c), (a, c, d))]
    return part(corners, np.array(faces), **other)


def faces_of(made: MeshPart) -> Counter[tuple[Any, ...]]:
    """All that is held of each face, in an order of its corners that any order leads to.

    What may change in a file is not in it: the order of faces, which corner is first, and where
    arrays hold what.
    """
    uvs = np.vstack([made.uvs, np.full((1, 2), -1)])
    found = []
    for face in range(len(made.faces)):
        chart = made.face_charts[face]
        corners = [
            (
                *made.positions[made.faces[face, i]].tolist(),
                *uvs[made.uv_faces[face, i]].tolist(),
                bool(made.creases[face, i]),
            )
            for i in range(3)
        ]
        turned = min(corners[i:] + corners[:i] for i in range(3))
        kind = int(made.chart_materials[chart]), bool(made.chart_has_uv[chart])
        found.append((*turned, kind, bool(made.sheet[face])))
    return Counter(found)


def vertices_of(made: MeshPart) -> Counter[tuple[Any, ...]]:
    """Of each vertex in use its position and those of its neighbors: which faces share it."""
    beside: dict[int, list[Any]] = {}
    for face in made.faces.tolist():
        for i, vertex in enumerate(face):
            others = face[(i + 1) % 3], face[(i + 2) % 3]
            beside.setdefault(vertex, []).append([made.positions[v].tolist() for v in others])
    return Counter(
        (str(made.positions[vertex].tolist()), str(sorted(around)))
        for vertex, around in beside.items()
    )


@st.composite
def parts(draw: st.DrawFn) -> MeshPart:
    """Any faces over few vertices: edges of many faces, twice the same face, loose triangles."""
    generator = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    made = draw(st.sampled_from([_soup, _surface]))(generator, draw(st.integers(1, 25)))
    positions = generator.integers(0, 1 << draw(st.integers(0, 20)), (made.max() + 1, 3))
    return _dressed(generator, positions, made, draw(st.integers(1, 4)), draw(st.booleans()))


def _soup(generator: np.random.Generator, count: int) -> IntArray:
    vertices = int(generator.integers(3, 4 + count))
    return np.array([generator.permutation(vertices)[:3] for _ in range(count)])


def _surface(generator: np.random.Generator, count: int) -> IntArray:
    """Most of a grid, bent around to a tube or a torus, now and then with a face turned over."""
    side = 2 + int(np.sqrt(count))
    wrap = generator.random(2) < 0.5
    rows, columns = np.divmod(np.arange(side * side), side)
    up, right = rows + 1, columns + 1
    inside = (
        ((up < side) | wrap[0]) & ((right < side) | wrap[1]) & (generator.random(len(up)) < 0.9)
    )
    inside[0] = True
    a, b = rows * side + columns, rows * side + right % side
    c, d = up % side * side + right % side, up % side * side + columns
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    faces = faces[np.tile(inside, 2)]
    turned = generator.random(len(faces)) < 0.02
    faces[turned] = faces[turned][:, ::-1]
    apart = [len(set(face)) == 3 for face in faces.tolist()]
    return faces[apart] if any(apart) else np.array([[0, 1, 2]])


def _dressed(
    generator: np.random.Generator, positions: IntArray, faces: IntArray, charts: int, many: bool
) -> MeshPart:
    """With charts anywhere, UVs by vertex, and at some corners others, creases, placements."""
    count = len(faces)
    has_uv = generator.random(charts) < 0.7
    face_charts = generator.integers(0, charts, count) if many else np.zeros(count, int)
    uvs = generator.integers(0, 1 << int(generator.integers(0, 21)), (len(positions) + 5, 2))
    odd = generator.random((count, 3)) < 0.05
    uv_faces = np.where(odd, generator.integers(0, len(uvs), (count, 3)), faces)
    uv_faces[~has_uv[face_charts]] = -1
    return part(
        positions,
        faces,
        uvs=uvs.astype(np.int32),
        uv_faces=uv_faces.astype(np.int32),
        face_charts=face_charts.astype(np.int32),
        chart_materials=generator.integers(0, 300, charts).astype(np.int32),
        chart_has_uv=has_uv,
        creases=_creases(generator, faces, len(positions)),
        sheet=generator.random(count) < generator.choice([0.0, 0.5, 1.0]),
        origin=tuple(generator.normal(size=3).astype(np.float32).tolist()),
        placements=(Placement(),) * int(generator.integers(1, 3)),
    )


def _creases(generator: np.random.Generator, faces: IntArray, vertices: int) -> AnyArray:
    """The same from both sides of an edge."""
    table = generator.random((vertices, vertices)) < 0.2 * (generator.random() < 0.5)
    table |= table.T
    return table[faces, np.roll(faces, -1, axis=1)]
