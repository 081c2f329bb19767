"""From the SDF network to a triangle mesh, with work that grows with the surface.

Blocks of the cube are kept, coarse to fine, while the field says that the surface may pass through
them; the field is then sampled on the grid points of the kept blocks only, and of those that the
surface goes on into; it is polygonized, and the vertices are moved onto the zero set.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import (
    BoolArray,
    Float32Array,
    Int8Array,
    Int32Array,
    Int64Array,
    Uint8Array,
    Uint32Array,
)
from nispcodec.core.network import Network
from nispcodec.extract.config import IsosurfaceConfig
from nispcodec.extract.grid import BLOCK, CUBE, Grid, chunks
from nispcodec.extract.marching_cubes import CORNERS, EDGES, polygonize
from nispcodec.extract.newton import onto_surface
from nispcodec.infer.evaluate import evaluate, gradient
from nispcodec.infer.parallel import parallel_for

# Nothing of the asset is outside of the ball of this radius.
BALL = 1.01
# From a grid point of a block to the next along each axis.
STRIDES = np.array([(BLOCK + 1) ** 2, BLOCK + 1, 1])
# Of each edge of a cell: from the cell's first corner to its low end, and its axis.
LOW_ENDS = CORNERS[[low for low, _ in EDGES]] @ STRIDES
AXES = np.array([axis for _, axis in EDGES], np.int8)


@dataclass(frozen=True)
class Surface:
    """positions (n, 3) float32, normalized frame; faces (m, 3) int32; cell: the grid's spacing.

    That of a simplified surface is the spacing of a grid that gives as many vertices.
    """

    positions: Float32Array
    faces: Int32Array
    cell: float


def extract(
    network: Network, resolution: int, config: IsosurfaceConfig = IsosurfaceConfig()
) -> Surface:
    """The zero set of the SDF network in the cube [-1.02, 1.02]^3 of the normalized frame.

    `resolution` is the least number of cells along an edge of the cube: it is rounded up, by an
    eighth at most, so that blocks halve evenly and none reaches out of the cube.
    """
    root, levels, cell = _grid(resolution, config)
    kept = _surface_blocks(network, root, levels, cell, config)
    blocks, values, points = _sampled(Grid(network, root * 2**levels, cell), kept)
    places, axes, faces = _polygons(values, points)
    crossings = _crossings(blocks, values.ravel(), places, axes, cell, config.clearance)
    return Surface(onto_surface(network, crossings, cell / 2, config.newton_steps), faces, cell)


def near_surface(
    network: Network, resolution: int, config: IsosurfaceConfig = IsosurfaceConfig()
) -> tuple[Float32Array, float]:
    """Centers (b, 3) of the blocks that `extract` would look into, and the blocks' size."""
    root, levels, cell = _grid(resolution, config)
    blocks = _surface_blocks(network, root, levels, cell, config)
    return _centers(blocks, BLOCK * cell), BLOCK * cell


def _grid(resolution: int, config: IsosurfaceConfig) -> tuple[int, int, float]:
    """Blocks along the cube at first, how often they are halved, and the size of a cell."""
    across = -(-resolution // BLOCK)
    levels = max(0, int(np.ceil(np.log2(across / config.root))))
    root = -(-across // 2**levels)
    return root, levels, 2 * CUBE / (root * 2**levels * BLOCK)


def _surface_blocks(
    network: Network, root: int, levels: int, cell: float, config: IsosurfaceConfig
) -> Int64Array:
    """Integer coordinates (b, 3) of the blocks of BLOCK^3 cells that may hold surface.

    A block is halved and kept while the field at its center is no larger than it may become over
    half the block's diagonal, and a margin; at the end, over half its edge: a surface that passes
    between the centers of two blocks is that close to one of them, and from there it is followed.
    How fast the field may grow is measured anew among the blocks of each level: far from the
    surface a fitted field is steeper than near it.
    """
    blocks = _lattice(root)
    for level in range(levels, -1, -1):
        size = cell * BLOCK * 2**level
        centers = _centers(blocks, size)
        if level == levels:
            bound = _steepness(network, centers)
        distance = np.abs(evaluate(network, centers)[:, 0])
        near = distance <= bound * size / 2 * (config.margin * np.sqrt(3) if level else 1)
        blocks = blocks[near]
        if level:
            bound = _steepness(network, centers[near])
            blocks = (2 * blocks[:, None] + CORNERS).reshape(-1, 3)
    return blocks


def _centers(blocks: Int64Array, size: float) -> Float32Array:
    return ((blocks + 0.5) * size - CUBE).astype(np.float32)


def _lattice(count: int) -> Int64Array:
    """All integer points of a cube, (count^3, 3), the last axis fastest."""
    return np.indices((count,) * 3).reshape(3, -1).T.astype(np.int64)


def _steepness(network: Network, points: Float32Array) -> float:
    """How steep the field is round most points: 1 for an SDF, for a fitted one only nearly."""
    slopes = np.linalg.norm(gradient(network, points)[1], axis=1)
    return float(np.percentile(slopes, 99, method="higher")) if len(slopes) else 1.0


def _sampled(grid: Grid, blocks: Int64Array) -> tuple[Int64Array, Float32Array, Int32Array]:
    """The blocks and all that the surface goes on into; what `Grid.sampled` says of them.

    Where it left them it would end in a hole.
    """
    parts = [(blocks, *grid.sampled(blocks))]
    while len(more := _behind(grid, *parts[-1][:2])):
        parts.append((more, *grid.sampled(more)))
    blocks, values, points = map(np.concatenate, zip(*parts, strict=True))
    return blocks, values, points


def _behind(grid: Grid, blocks: Int64Array, values: Float32Array) -> Int64Array:
    """Blocks (b, 3) of the cube that were not sampled, and lie behind a face that is crossed."""
    inside = np.empty(len(values), np.uint32)

    def look(part: slice) -> None:
        inside[part] = _bits((values[part] < 0).reshape(-1, (BLOCK + 1) ** 3))

    parallel_for(look, chunks(len(values)))
    corners = _lattice(BLOCK + 1)
    beyond = []
    for axis in range(3):
        for side, step in ((0, -1), (BLOCK, 1)):
            face = _bits(corners[:, axis] == side)
            neighbors = blocks[(inside & face != 0) & (inside & face != face)]
            neighbors[:, axis] += step
            place = neighbors[:, axis]
            beyond.append(neighbors[(place >= 0) & (place < grid.across)])
    wanted = np.concatenate(beyond)
    cube = (grid.across,) * 3
    missing = np.unique(np.ravel_multi_index(tuple(wanted[~grid.has_sampled(wanted)].T), cube))
    return np.stack(np.unravel_index(missing, cube), axis=1)


def _bits(flags: BoolArray) -> Uint32Array:
    """The (BLOCK + 1)^3 flags of each block (..., 27) as one number."""
    return np.packbits(flags, axis=-1).view(">u4")[..., 0]


def _polygons(values: Float32Array, points: Int32Array) -> tuple[Int64Array, Int8Array, Int32Array]:
    """The crossed grid edges: where their low ends are in `values` (n,), their axes; faces (m, 3).

    An edge is known by the number of its low point, so that no sorting is needed to find the same
    edge in several cells.
    """
    table = np.zeros(3 * (int(points.max(initial=0)) + 1), np.int32)
    parts = chunks(len(values))
    edges = [np.empty((0, 3), np.int32)] * max(1, len(parts))

    def find(number: int) -> None:
        places, axes = _triangles(values[parts[number]])
        places += parts[number].start * (BLOCK + 1) ** 3
        edges[number] = 3 * points.ravel()[places] + axes
        # Where an edge's low end is, and one, so that 0 is an edge not crossed. Blocks that share
        # the edge know it by places of their own, whichever is kept: they hold the same.
        table[edges[number]] = places + 1

    def renumber(number: int) -> None:
        edges[number] = table[edges[number]]

    parallel_for(find, range(len(parts)))
    crossed = np.flatnonzero(table)
    lowest = table[crossed] - 1
    table[crossed] = np.arange(len(crossed))
    parallel_for(renumber, range(len(parts)))
    return lowest.astype(np.int64), (crossed % 3).astype(np.int8), np.concatenate(edges)


def _triangles(values: Float32Array) -> tuple[Int64Array, Int8Array]:
    """Triangles' edges (t, 3): where their low ends are in the values of all blocks, their axes."""
    cases = _cases(values)
    cells = np.flatnonzero((cases > 0) & (cases < 255))
    owners, edges = polygonize(cases[cells])
    return _first_corners(cells)[owners, None] + LOW_ENDS[edges], AXES[edges]


def _cases(values: Float32Array) -> Uint8Array:
    """The case of every cell of every block, (b * BLOCK^3,)."""
    inside = values < 0
    cases = np.zeros((len(values), *(BLOCK,) * 3), np.uint8)
    for i, corner in enumerate(CORNERS):
        window = (slice(None), *(slice(c, c + BLOCK) for c in corner))
        cases |= inside[window].astype(np.uint8) << i
    return cases.ravel()


def _first_corners(cells: Int64Array) -> Int64Array:
    """Where cells' lowest corners are in the values of all blocks."""
    block, inner = np.divmod(cells, BLOCK**3)
    return block * (BLOCK + 1) ** 3 + (_lattice(BLOCK) @ STRIDES)[inner]


def _crossings(
    blocks: Int64Array,
    values: Float32Array,
    places: Int64Array,
    axes: Int8Array,
    cell: float,
    clearance: float,
) -> Float32Array:
    """Where the field crosses zero along each edge, if it were linear."""
    lattice = _lattice(BLOCK + 1)
    found = np.empty((len(places), 3), np.float32)

    def cross(part: slice) -> None:
        lows, along = places[part], axes[part]
        low, high = values[lows], values[lows + STRIDES[along]]
        block, inner = np.divmod(lows, (BLOCK + 1) ** 3)
        grid = (blocks[block] * BLOCK + lattice[inner]).astype(np.float64)
        grid[np.arange(len(grid)), along] += np.clip(low / (low - high), clearance, 1 - clearance)
        found[part] = grid * cell - CUBE

    parallel_for(cross, chunks(len(places)))
    return found
