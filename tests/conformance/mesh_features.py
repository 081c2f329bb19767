"""The mesh parts of the conformance files: every feature of section 15 once, few triangles each."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from typing import Any

import numpy as np

from nispcodec.core.arrays import AnyArray, Float64Array, IntArray
from nispcodec.core.asset import Material, Texture, TextureMap
from nispcodec.core.document import Document, Frame
from nispcodec.core.mesh_part import MeshPart, Placement
from tests.infer.parts import CUBE_FACES

BITS = 10
STEP = 2.0**-9
UV_STEP = 2.0**-10
"""Of positions, which span -1 to 1, and of UVs, which span 0 to 1."""
MATERIALS = tuple(
    Material(f"m{number}", (red, green, blue, 1.0))
    for number, (red, green, blue) in enumerate(
        [(0.8, 0.1, 0.1), (0.1, 0.7, 0.2), (0.2, 0.3, 0.9), (0.9, 0.8, 0.1), (0.5, 0.5, 0.5)]
    )
)


def part(corners: Float64Array, faces: IntArray, **other: Any) -> MeshPart:
    """Vertices (n, 3) from -1 to 1 and faces (m, 3): one chart without UVs, or what else is given.

    Faces with UVs have those of `uvs` (t, 2) from 0 to 1 that `uv_faces` says.
    """
    uvs = np.rint(np.asarray(other.pop("uvs", np.zeros((0, 2)))) / UV_STEP).astype(np.int32)
    charts = np.asarray(other.pop("face_charts", np.zeros(len(faces))), np.int32)
    count = int(charts.max()) + 1
    fields: dict[str, Any] = {
        "uv_faces": np.full((len(faces), 3), -1),
        "chart_materials": np.zeros(count, np.int32),
        "chart_has_uv": np.full(count, len(uvs) > 0),
        "creases": np.zeros((len(faces), 3), np.bool_),
        "sheet": np.zeros(len(faces), np.bool_),
        "step": STEP,
        "origin": (-1.0, -1.0, -1.0),
        "uv_step": (UV_STEP, UV_STEP),
    } | other
    return MeshPart(
        positions=np.rint((corners + 1) / STEP).astype(np.int32),
        faces=np.asarray(faces, np.int32),
        uvs=uvs,
        face_charts=charts,
        **{**fields, "uv_faces": np.asarray(fields["uv_faces"], np.int32)},
    )


def asset(*parts: MeshPart, **other: Any) -> Document:
    """Parts alone, in plain colors."""
    frame = Frame((0.0, 0.0, 0.0), 1.0)
    fields: dict[str, Any] = {"frame": frame, "materials": MATERIALS, "textures": ()} | other
    return Document(meshes=parts, **fields)


def painted(image: Texture, *parts: MeshPart, **other: Any) -> Document:
    """Parts whose first material has a texture."""
    first = Material("painted", maps={"base_color": TextureMap(0)})
    materials = (first, *MATERIALS[1:])
    return asset(*parts, materials=materials, textures=(image,), **other)


def box_corners(size: float = 0.4, middle: tuple[float, float, float] = (0, 0, 0)) -> Float64Array:
    """(8, 3) of a box whose sides are as 2, 3 and 4."""
    signs = np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)], np.float64)
    found: Float64Array = signs * size * [0.5, 0.75, 1.0] + middle
    return found


def box(**other: Any) -> MeshPart:
    """A closed box."""
    return part(box_corners(), CUBE_FACES, **other)


def mapped(axes: tuple[int, int] = (0, 1)) -> dict[str, Any]:
    """UVs of the box: a side's own square of a map, each pair of faces a chart."""
    corners = box_corners(1.0)
    uvs: list[tuple[float, float]] = []
    uv_faces: list[int] = []
    for face, three in enumerate(CUBE_FACES):
        flat = next(axis for axis in range(3) if np.ptp(corners[three][:, axis]) == 0)
        kept = [axis for axis in range(3) if axis != flat]
        side = face // 2
        for vertex in three:
            u, v = (np.sign(corners[vertex][axis]) * 0.5 + 0.5 for axis in kept)
            if axes != (0, 1):
                u, v = v, u
            uv_faces.append(len(uvs))
            uvs.append((side % 3 / 3 + u * 0.3, side // 3 / 2 + v * 0.45))
    return {
        "uvs": np.array(uvs),
        "uv_faces": np.array(uv_faces).reshape(-1, 3),
        "face_charts": np.arange(12) // 2,
    }


def grid(side: int = 3, bend: float = 0.2, **other: Any) -> MeshPart:
    """A sheet that bends, one chart, UVs as x and y."""
    line = np.linspace(-0.7, 0.7, side + 1)
    x, y = (each.ravel() for each in np.meshgrid(line, line))
    first = np.array([row * (side + 1) + at for row in range(side) for at in range(side)])
    a, b, c, d = first, first + 1, first + side + 2, first + side + 1
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    corners = np.stack([x, y, bend * np.sin(3 * x + y)], axis=1)
    fields: dict[str, Any] = {
        "uvs": np.stack([(x + 0.7) / 1.5, (y + 0.7) / 1.6], axis=1),
        "uv_faces": faces,
        "sheet": np.ones(len(faces), np.bool_),
    } | other
    return part(corners, faces, **fields)


def torus(rows: int = 6, columns: int = 5) -> MeshPart:
    """A closed surface with a hole, its map cut open along two seams."""
    up, around = np.meshgrid(np.arange(rows + 1), np.arange(columns + 1), indexing="ij")
    turn, tilt = 2 * np.pi * up / rows, 2 * np.pi * around / columns
    away = 0.6 + 0.25 * np.cos(tilt)
    places = np.stack([away * np.cos(turn), away * np.sin(turn), 0.25 * np.sin(tilt)], axis=2)
    uvs = np.stack([up / rows, around / columns], axis=2).reshape(-1, 2)
    vertices = (up % rows * columns + around % columns).ravel()
    row, column = (each.ravel() for each in np.meshgrid(range(rows), range(columns)))
    a = row * (columns + 1) + column
    b, c, d = a + columns + 1, a + columns + 2, a + 1
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    corners = places[:rows, :columns].reshape(-1, 3)
    return part(corners, vertices[faces], uvs=uvs * 0.999, uv_faces=faces)


def mesh_features(image: Texture, beside: Document) -> Iterator[tuple[str, Document]]:
    """Name and document of each file; `beside` has a field, and a texture as `image`."""
    yield "mesh", asset(box(), frame=Frame((10.0, -20.0, 0.5), 2.5))
    yield "mesh-sheet", painted(image, grid())
    yield "mesh-uv-scales", painted(image, _scaled_uvs())
    yield "mesh-body-and-sheet", asset(_body_and_sheet())
    yield "mesh-torus", painted(image, torus())
    yield "mesh-charts", painted(image, _charts())
    yield "mesh-uv-partly", painted(image, _partly())
    yield "mesh-stacked", painted(image, _stacked())
    yield "mesh-creases", asset(_creased())
    yield "mesh-edge-of-four", asset(_edge_of_four())
    yield "mesh-sheets-in-one-edge", asset(three_sheets())
    yield "mesh-inside-out", asset(part(box_corners(), CUBE_FACES[:, ::-1]))
    yield "mesh-overlap", asset(_overlap())
    yield "mesh-open", asset(part(box_corners(), CUBE_FACES[:6]))
    yield "mesh-without-area", asset(_without_area())
    yield "mesh-soup", painted(image, soup())
    yield "mesh-fine", asset(_fine())
    yield "mesh-copies", painted(image, dataclasses.replace(_partly(), placements=_copies()))
    yield "mesh-copy-moved", asset(dataclasses.replace(_wedge(), placements=_copies()[1:2]))
    yield "mesh-copy-mirrored", asset(dataclasses.replace(_wedge(), placements=_mirrored()))
    yield "mesh-parts", painted(image, _partly(), _small(), grid(2, 0.1, origin=(-1, -1, -0.25)))
    yield "mesh-and-field", _joined(beside, dataclasses.replace(_partly(), placements=_apart()))
    yield "mesh-and-openings", _joined(_opened(beside), _small())
    yield "mesh-parts-overlap", asset(box(), part(box_corners(0.4, (0.3, 0.2, 0.1)), CUBE_FACES))
    yield "mesh-sheet-in-body", asset(_sheet_in_body())
    yield "mesh-copy-long-rotation", asset(dataclasses.replace(_wedge(), placements=_longer()))
    yield "mesh-fan", painted(image, _fan())
    yield "mesh-wheels", painted(image, _wheels())
    yield "mesh-book", painted(image, _book())
    yield "mesh-crowd", painted(image, _crowd(7, 60, 1))
    yield "mesh-larger-crowd", painted(image, _crowd(12, 80, 0))
    yield "mesh-many-faces", painted(image, _bumpy())


def _joined(beside: Document, *parts: MeshPart) -> Document:
    materials = (*beside.materials, *MATERIALS[1:])
    return dataclasses.replace(beside, meshes=parts, materials=materials)


def _opened(beside: Document) -> Document:
    assert beside.field
    flags = np.array([1, 0], np.bool_)
    charts = dataclasses.replace(beside.field.charts, has_uv=flags, openings=True)
    return dataclasses.replace(beside, field=dataclasses.replace(beside.field, charts=charts))


def _scaled_uvs() -> MeshPart:
    """UVs far outside of [0, 1], in steps of two lengths."""
    return grid(2, 0.3, uv_step=(0.003, 0.005), uv_origin=(-1.25, 0.375))


def _body_and_sheet() -> MeshPart:
    """A box of two charts, and beside it two faces that have no inside."""
    sheet = np.array([[0.5, -0.6, -0.5], [0.6, 0.6, -0.4], [0.5, 0.5, 0.6], [0.7, -0.6, 0.5]])
    faces = np.concatenate([CUBE_FACES, [[8, 9, 10], [8, 10, 11]]])
    corners = np.concatenate([box_corners(0.5, (-0.2, 0, 0)), sheet])
    return part(corners, faces, sheet=np.arange(14) >= 12, face_charts=np.arange(14) // 6)


def _sheet_in_body() -> MeshPart:
    """A box, and in it six faces around a point that have no inside."""
    turn = np.arange(6) * np.pi / 3
    rim = np.stack([0.1 * np.cos(turn), 0.3 * np.sin(turn), 0.1 * np.cos(2 * turn)], axis=1)
    corners = np.concatenate([box_corners(0.8), rim, [[0.02, 0.01, 0.05]]])
    fan = np.stack([np.full(6, 14), 8 + np.arange(6), 8 + (np.arange(6) + 1) % 6], axis=1)
    faces = np.concatenate([CUBE_FACES, fan])
    return part(corners, faces, sheet=np.arange(18) >= 12, face_charts=np.arange(18) // 12)


def _charts() -> MeshPart:
    """Six charts of five materials, of which the first has a map."""
    materials = np.array([0, 1, 2, 3, 4, 0], np.int32)
    return dataclasses.replace(box(**mapped()), chart_materials=materials)


def _partly() -> MeshPart:
    """Charts with UVs and charts without."""
    made = box(**mapped((1, 0)))
    has_uv = np.array([1, 0, 1, 1, 0, 1], np.bool_)
    uv_faces = np.where(has_uv[made.face_charts][:, None], made.uv_faces, -1)
    materials = np.array([0, 1, 0, 0, 2, 3], np.int32)
    return dataclasses.replace(
        made, chart_has_uv=has_uv, uv_faces=uv_faces, chart_materials=materials
    )


def _stacked() -> MeshPart:
    """Three sheets one above the other whose charts lie over each other, one of them mirrored."""
    one = grid(3, 0.1)
    count, uvs = len(one.positions), one.uvs
    places = np.concatenate([one.positions + np.array([0, 0, shift]) for shift in (-300, 0, 300)])
    flipped = np.stack([uvs[:, 0].max() - uvs[:, 0], uvs[:, 1]], axis=1)
    faces = np.concatenate([one.faces + count * copy for copy in range(3)])
    return part(
        places * STEP - 1,
        faces,
        uvs=np.concatenate([uvs, uvs, flipped]) * UV_STEP,
        uv_faces=faces,
        face_charts=np.repeat(range(3), len(one.faces)),
        sheet=np.ones(len(faces), np.bool_),
    )


def _creased() -> MeshPart:
    """A sheet with creases inside of it, on both sides of an edge, and at its border."""
    made = grid(3, 0.3)
    edges = np.sort(np.stack([made.faces, np.roll(made.faces, -1, axis=1)], axis=2), axis=2)
    return dataclasses.replace(made, creases=(edges[:, :, 0] * 7 + edges[:, :, 1]) % 3 == 0)


def _edge_of_four() -> MeshPart:
    """Two boxes that touch in an edge, whose ends they share, and four faces meet there."""
    first, second = box_corners(0.5, (-0.25, -0.375, 0)), box_corners(0.5, (0.25, 0.375, 0))
    corners, faces = np.unique(np.concatenate([first, second]), axis=0, return_inverse=True)
    both = np.concatenate([CUBE_FACES, CUBE_FACES + 8])
    return part(corners, faces.ravel()[both], face_charts=np.arange(24) // 12)


def three_sheets() -> MeshPart:
    """Three half planes that end in one line."""
    line = np.array([[0, 0, -0.6], [0, 0, 0.6]])
    turns = np.array([0.3, 2.1, 4.5])
    ends = [[0.7 * np.cos(turn), 0.7 * np.sin(turn), z] for turn in turns for z in (-0.5, 0.5)]
    faces = [[0, 2 + 2 * i, 3 + 2 * i] for i in range(3)] + [[0, 3 + 2 * i, 1] for i in range(3)]
    return part(
        np.concatenate([line, ends]),
        np.array(faces),
        sheet=np.ones(6, np.bool_),
        face_charts=np.arange(6) % 3,
        chart_materials=np.array([1, 2, 3], np.int32),
    )


def _overlap() -> MeshPart:
    """Two bodies, one partly in the other."""
    corners = np.concatenate([box_corners(0.5), box_corners(0.4, (0.3, 0.2, 0.1))])
    return part(corners, np.concatenate([CUBE_FACES, CUBE_FACES + 8]))


def _without_area() -> MeshPart:
    """A wedge, a triangle that is a line, and one that is a point."""
    line = np.array([[0.6, 0.6, 0.6], [0.7, 0.7, 0.7], [0.9, 0.9, 0.9]])
    point = np.full((3, 3), -0.7)
    made = _wedge()
    corners = np.concatenate([made.positions * STEP - 1, line, point])
    faces = np.concatenate([made.faces, [[4, 5, 6], [7, 8, 9]]])
    return part(
        corners, faces, sheet=np.arange(6) >= 4, face_charts=np.maximum(np.arange(6) - 3, 0)
    )


def soup() -> MeshPart:
    """Triangles that have little to do with each other, with UVs and edges of many faces."""
    generator = np.random.default_rng(8)
    faces = np.array([generator.permutation(12)[:3] for _ in range(24)])
    odd = generator.random((24, 3)) < 0.3
    uv_faces = np.where(odd, generator.integers(0, 16, (24, 3)), faces)
    return part(
        generator.uniform(-0.8, 0.8, (12, 3)),
        faces,
        uvs=generator.random((16, 2)),
        uv_faces=uv_faces,
        sheet=np.ones(24, np.bool_),
        creases=generator.random((12, 12))[faces, np.roll(faces, -1, axis=1)] < 0.2,
    )


def _crowd(corners: int, faces: int, seed: int) -> MeshPart:
    """So many triangles on few corners that some have more faces than are looked at."""
    generator = np.random.default_rng(seed)
    made = np.array([generator.permutation(corners)[:3] for _ in range(faces)])
    places = generator.uniform(-0.8, 0.8, (corners, 3))
    uvs = generator.random((corners, 2)) ** 3 * 0.3
    return part(places, made, uvs=uvs, uv_faces=made, sheet=np.ones(faces, np.bool_))


def _fan(spokes: int = 20) -> MeshPart:
    """Two cones over one ring, on a grid of sixteen bits."""
    turn = np.arange(spokes) * 2 * np.pi / spokes
    ring = np.stack([0.6 * np.cos(turn), 0.6 * np.sin(turn), 0.1 * np.cos(3 * turn)], axis=1)
    corners = np.concatenate([ring, [[0.05, 0.0, 0.7], [0.0, 0.05, -0.6]]])
    here, there = np.arange(spokes), np.roll(np.arange(spokes), -1)
    top, low = np.full(spokes, spokes), np.full(spokes, spokes + 1)
    faces = np.concatenate(
        [np.stack([here, there, top], axis=1), np.stack([there, here, low], axis=1)]
    )
    uvs = np.concatenate([ring[:, :2] * 0.4 + 0.5, [[0.5, 0.5], [0.52, 0.48]]])
    made = part(corners, faces, uvs=uvs, uv_faces=faces)
    finer = np.random.default_rng(3).integers(0, 64, made.positions.shape)
    places = (made.positions * 64 + finer).astype(np.int32)
    return dataclasses.replace(made, positions=places, step=STEP / 64)


def _wheels(spokes: int = 24, turn: int = 19) -> MeshPart:
    """Three wheels over one place in the texture, each of which begins at another spoke."""
    angle = np.arange(spokes) * 2 * np.pi / spokes
    rim = np.stack([0.6 * np.cos(angle), 0.6 * np.sin(angle), 0 * angle], axis=1)
    corners = np.concatenate([rim, [[0.0, 0.0, 0.1]]])
    here = np.arange(spokes)
    one = np.stack([np.full(spokes, spokes), here, (here + 1) % spokes], axis=1)
    turned = [np.roll(one, -turn * copy, axis=0) for copy in range(3)]
    return part(
        np.concatenate([corners + np.array([0, 0, (copy - 1) / 2]) for copy in range(3)]),
        np.concatenate([each + copy * (spokes + 1) for copy, each in enumerate(turned)]),
        uvs=np.concatenate([rim[:, :2] * 0.6 + 0.5, [[0.5, 0.5]]]),
        uv_faces=np.concatenate(turned),
        face_charts=np.repeat(range(3), spokes),
        sheet=np.ones(3 * spokes, np.bool_),
    )


def _book(pages: int = 18, again: int = 15) -> MeshPart:
    """Triangles that have one edge of the texture in common, the last three on the sixteenth."""
    order = [*range(pages), again, again]
    tips = [[0.15 + 0.04 * page, 0.5 + 0.01 * (page % 3)] for page in range(pages)]
    corners = [
        place
        for height, page in zip(np.linspace(-0.8, 0.72, len(order)), order, strict=True)
        for place in (
            [-0.5, -0.4, height],
            [-0.5, 0.4, height + 0.01],
            [-0.4 + 0.04 * page, 0.0, height],
        )
    ]
    return part(
        np.array(corners),
        np.arange(3 * len(order)).reshape(-1, 3),
        uvs=np.array([[0.1, 0.1], [0.1, 0.9], *tips]),
        uv_faces=np.array([[0, 1, 2 + page] for page in order]),
        face_charts=np.arange(len(order)),
        sheet=np.ones(len(order), np.bool_),
    )


def _bumpy(side: int = 12) -> MeshPart:
    """A sheet of so many faces that counters are full, everything a little off."""
    generator, made = np.random.default_rng(1), grid(side)
    count = len(made.positions)
    places = made.positions * STEP - 1 + generator.normal(0, (0.02, 0.02, 0.05), (count, 3))
    uvs = made.uvs * UV_STEP + generator.normal(0, 0.01, (count, 2))
    faces = made.faces
    return part(
        places.clip(-1, 1),
        faces,
        uvs=uvs.clip(0, 1),
        uv_faces=faces,
        sheet=np.ones(len(faces), np.bool_),
    )


def _fine() -> MeshPart:
    """A grid of twenty bits, an origin and a step that are no powers of two."""
    generator = np.random.default_rng(9)
    places: AnyArray = generator.integers(0, 2**20, (8, 3))
    made = part(np.zeros((8, 3)), CUBE_FACES, sheet=np.ones(12, np.bool_))
    return dataclasses.replace(
        made, positions=places.astype(np.int32), step=1.5e-6, origin=(-0.75, -0.8, -0.7)
    )


def _wedge() -> MeshPart:
    """A tetrahedron without symmetry, each face a chart of its own material."""
    corners = np.array([[-0.3, -0.4, -0.5], [0.6, -0.3, -0.4], [-0.2, 0.5, -0.3], [0.1, 0, 0.7]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    materials = np.array([1, 2, 3, 4], np.int32)
    return part(corners, faces, face_charts=np.arange(4), chart_materials=materials)


def _small() -> MeshPart:
    """The wedge at a fifth of its size, away from the middle."""
    return dataclasses.replace(_wedge(), step=0.2 * STEP, origin=(0.3, 0.25, 0.2))


def _turn(w: float, x: float, y: float, z: float) -> tuple[float, float, float, float]:
    """A unit quaternion in float32."""
    length = float(np.sqrt(w * w + x * x + y * y + z * z))
    a, b, c, d = (float(np.float32(each / length)) for each in (w, x, y, z))
    return a, b, c, d


def _copies() -> tuple[Placement, ...]:
    """A copy in place, one turned and scaled, one mirrored, one of other materials and map."""
    others = np.array([3, 0, 4, 0, 1, 2], np.int32)
    return (
        Placement(scale=0.5, offset=(-0.5, -0.5, 0.0)),
        Placement(_turn(5, 1, -2, 3), (0.5, -0.375, 0.25), 0.625),
        Placement(_turn(1, 3, 2, 1), (-0.25, 0.5, 0.25), 0.5, True),
        Placement(
            offset=(0.5, 0.5, -0.25),
            scale=0.375,
            mirrored=True,
            uv_scale=(0.5, -1.5),
            uv_offset=(0.25, 0.625),
            materials=others,
        ),
    )


def _longer() -> tuple[Placement, ...]:
    """A copy whose quaternion is as long as it may be: readers divide by its length."""
    w, x, y, z = _turn(5, 1, -2, 3)
    return (Placement((1.00045 * w, 1.00045 * x, 1.00045 * y, 1.00045 * z), (0.25, 0.0, 0.25)),)


def _mirrored() -> tuple[Placement, ...]:
    """A copy and its mirror image over it: faces of both look outwards."""
    return Placement(), Placement(mirrored=True)


def _apart() -> tuple[Placement, ...]:
    """Two small copies beside a field."""
    return (
        Placement(offset=(0.5, 0.25, 0.0), scale=0.5),
        Placement(_turn(1, 1, 0, 2), (-0.5, -0.25, 0.25), 0.5, True, (0.5, 0.5), (0.25, 0.0)),
    )
