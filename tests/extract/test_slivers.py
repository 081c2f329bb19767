"""Slivers go, and everything else stays: a closed surface, and the borders between its charts."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from nispcodec.core.arrays import Float32Array, Float64Array, Int32Array, Int64Array
from nispcodec.core.network import Network
from nispcodec.extract.config import SliverConfig
from nispcodec.extract.isosurface import Surface, extract
from nispcodec.extract.seams import cut_along_seams
from nispcodec.extract.simplify import deviation, simplified
from nispcodec.extract.sliver_operations import Shapes
from nispcodec.extract.slivers import without_slivers
from nispcodec.extract.vertex_charts import vertex_charts
from nispcodec.extract.wedges import Wedges
from nispcodec.infer.evaluate import gradient
from tests import tiny
from tests.extract.surfaces import areas, assert_closed

SHAPES: dict[str, Callable[[], Network]] = {"ball": tiny.sphere, "octahedron": tiny.octahedron}
CHARTS = {"halves": tiny.halves, "octants": tiny.octants}


def badness(network: Network, surface: Surface) -> Float64Array:
    normals = gradient(network, surface.positions)[1]
    shapes = Shapes.of(surface.positions, normals, SliverConfig())
    return shapes.badness(surface.faces.astype(np.int64))


def tilted(seed: int) -> Network:
    """Two charts that a random plane parts: cuts as near to vertices as chance has it."""
    normal = np.random.default_rng(seed).normal(size=3)
    sides = np.stack([normal, -normal])
    offset = np.array([0.1, -0.1])
    return tiny.relu_network([(sides, offset), (np.eye(2), np.zeros(2))])


def cut(network: Network, chart: Network, faces: int) -> tuple[Surface, Int32Array]:
    fewer = simplified(network, extract(network, 48), faces)
    return cut_along_seams(network, chart, fewer, vertex_charts(chart, fewer))


def borders(surface: Surface, charts: Int32Array) -> Int64Array:
    """The vertices where charts meet."""
    pairs = np.unique(np.stack([surface.faces.ravel(), np.repeat(charts, 3)], axis=1), axis=0)
    return np.flatnonzero(np.bincount(pairs[:, 0], minlength=len(surface.positions)) > 1)


def border_edges(surface: Surface, charts: Int32Array) -> Int64Array:
    """The vertices (2, e) at both ends of the edges where charts meet."""
    wedges = Wedges.of(surface.faces.astype(np.int64), charts)
    return np.stack([wedges.starts[wedges.border], wedges.ends[wedges.border]])


def to_segments(points: Float64Array, starts: Float32Array, ends: Float32Array) -> Float64Array:
    """The distance of each point (k, 3) to the nearest of the segments (e, 3)."""
    along = (ends - starts).astype(np.float64)
    off = points[:, None] - starts
    shares = np.clip((off * along).sum(axis=2) / (along**2).sum(axis=1), 0, 1)
    distances: Float64Array = np.linalg.norm(off - shares[..., None] * along, axis=2).min(axis=1)
    return distances


@pytest.mark.parametrize("faces", [2000, 600])
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("seed", range(2))
def test_slivers_go_and_the_surface_stays(shape: str, seed: int, faces: int) -> None:
    network: Network = SHAPES[shape]()
    before, charts = cut(network, tilted(seed), faces)
    bad = (badness(network, before) > SliverConfig.aspect).sum()
    assert bad
    after, kept = without_slivers(network, before, charts)
    left = badness(network, after)
    assert left.max() <= SliverConfig.aspect
    assert_closed(after.faces)
    assert len(after.faces) <= len(before.faces)
    assert len(np.unique(after.faces)) == len(after.positions)
    assert deviation(network, after) < 1.2 * deviation(network, before) + 5e-5
    for chart in range(2):
        area = [
            areas(each.positions, each.faces)[of == chart].sum()
            for each, of in ((before, charts), (after, kept))
        ]
        assert area[1] == pytest.approx(area[0], rel=0.02)


@pytest.mark.parametrize("chart", CHARTS)
def test_borders_keep_their_course(chart: str) -> None:
    network = tiny.sphere()
    before, charts = cut(network, CHARTS[chart](), 800)
    after, kept = without_slivers(network, before, charts)
    left = after.positions[borders(after, kept)].astype(np.float64)
    assert len(left)
    assert to_segments(left, *before.positions[border_edges(before, charts)]).max() < 1e-6
    # Where three charts meet they still do.
    assert set(np.unique(kept)) == set(np.unique(charts))


def flat(points: list[tuple[float, float]], faces: list[tuple[int, int, int]]) -> Surface:
    """A piece of the plane z = 0 of the normalized frame, open all around."""
    positions = np.array([(x, y, 0) for x, y in points], np.float32)
    return Surface(positions, np.array(faces, np.int32), 0.1)


UP = tiny.relu_network([(np.array([[0, 0, 1.0]]), np.ones(1)), (np.ones((1, 1)), -np.ones(1))])
"""The height z."""


def test_the_long_side_of_a_cap_is_flipped() -> None:
    cap = flat([(0, 0), (1, 0), (0.5, 0.001), (0.5, -1)], [(0, 1, 2), (1, 0, 3)])
    after, charts = without_slivers(UP, cap, np.zeros(2, np.int32))
    assert len(after.faces) == len(charts) == 2
    assert all({2, 3} <= set(face) for face in after.faces.tolist())
    # Two charts have a border there, which stays.
    kept, _ = without_slivers(UP, cap, np.array([0, 1], np.int32))
    assert np.array_equal(kept.faces, cap.faces)


def test_a_fold_goes() -> None:
    # The vertex in the middle lies outside of the square: one face is turned over.
    corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.5, -0.02)]
    fold = flat(corners, [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])
    assert badness(UP, fold).max() == SliverConfig.turned
    after, _ = without_slivers(UP, fold, np.zeros(4, np.int32))
    assert badness(UP, after).max() < 10
    assert areas(after.positions, after.faces).sum() == pytest.approx(1)


def test_a_vertex_slides_where_neither_collapse_nor_flip_helps() -> None:
    # Its neighbors are the corners of a star, which none of them sees all of.
    star = [(0.1, 0.0), (0.7, 0.7), (0.1, 0.2), (-0.8, 0.6), (0.1, -0.1)]
    spokes = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5), (0, 5, 1)]
    needle, charts = flat([(0.0, 0.0), *star], spokes), np.zeros(5, np.int32)
    assert badness(UP, needle).max() > 100
    stuck, _ = without_slivers(UP, needle, charts, SliverConfig(slides=()))
    assert np.array_equal(stuck.faces, needle.faces)
    after, _ = without_slivers(UP, needle, charts)
    assert badness(UP, after).max() < SliverConfig.aspect
    assert {tuple(point) for point in needle.positions[1:]} <= {*map(tuple, after.positions)}
    assert areas(after.positions, after.faces).sum() == pytest.approx(
        areas(needle.positions, needle.faces).sum()
    )


def test_what_cannot_be_mended_is_left_as_it_is() -> None:
    needle = flat([(0, 0), (1, 0), (1, 0.001)], [(0, 1, 2)])
    after, charts = without_slivers(UP, needle, np.zeros(1, np.int32))
    assert np.array_equal(after.faces, needle.faces)
    assert np.array_equal(charts, [0])


def test_borders_move_a_little_for_the_last_needles() -> None:
    # Two borders pass a hair from each other, across which there is an edge that is none.
    points = [
        (0.0, 0.0),
        (0.01, 0.0),
        (-0.3, 1.0),
        (0.3, 1.0),
        (-0.3, -1.0),
        (0.3, -1.0),
        (-1.0, 0.0),
        (1.0, 0.0),
    ]
    middle, sides = [(0, 1, 3), (0, 3, 2), (1, 0, 4), (1, 4, 5)], [(0, 2, 6), (6, 4, 0)]
    surface = flat(points, [*middle, *sides, (1, 7, 3), (1, 5, 7)])
    charts = np.repeat([0, 1, 2], [4, 2, 2]).astype(np.int32)
    kept, _ = without_slivers(UP, surface, charts, SliverConfig(stray=0, slides=()))
    assert badness(UP, kept).max() > 100
    after, left = without_slivers(UP, surface, charts, SliverConfig(slides=()))
    assert badness(UP, after).max() < SliverConfig.aspect
    for chart in range(3):
        area = areas(after.positions, after.faces)[left == chart].sum()
        assert area == pytest.approx(
            areas(surface.positions, surface.faces)[charts == chart].sum(), rel=0.02
        )


def test_shape_counts_where_normals_tell_no_side() -> None:
    # Two corners on either side of a wall, so that the better diagonal has both turned over.
    sides = tiny.relu_network(
        [(np.array([[0, 0, 1.0], [0, 0, -1]]), np.zeros(2)), (np.ones((1, 2)), -np.ones(1))]
    )
    cap = flat([(0, 0), (1, 0), (0.5, 0.001), (0.5, -1)], [(0, 1, 2), (1, 0, 3)])
    cap.positions[:, 2] = [1e-4, 1e-4, -1e-4, -1e-4]
    charts = np.zeros(2, np.int32)
    kept, _ = without_slivers(sides, cap, charts, SliverConfig(told=0))
    assert np.array_equal(kept.faces, cap.faces)
    after, _ = without_slivers(sides, cap, charts)
    assert all({2, 3} <= set(face) for face in after.faces.tolist())
