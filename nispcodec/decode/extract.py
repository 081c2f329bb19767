"""From the SDF network to a triangle mesh, with work that grows with the surface.

Blocks of the cube are kept, coarse to fine, while the field says that the surface may pass through
them; the field is then sampled on the grid points of the kept blocks only, and of those that the
surface goes on into; it is polygonised, and the vertices are moved onto the zero set.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nispcodec.decode.evaluate import evaluate, gradient
from nispcodec.decode.marching import CORNERS, EDGES, polygonise
from nispcodec.decode.newton import onto_surface
from nispcodec.network import Network

LIMIT = 1.02
# Nothing of the asset is outside of this ball.
OUTSIDE = 1.01
BLOCK = 2
ROOT = 32
NEWTON_STEPS = 2
# Vertices keep this share of a cell from grid points, where several would coincide.
CLEARANCE = 0.01
# Blocks whose points are evaluated at a time, which bounds memory.
TOGETHER = 4096
# From a grid point of a block to the next along each axis.
STRIDES = np.array([(BLOCK + 1) ** 2, BLOCK + 1, 1])

Ids = NDArray[np.int64]
Floats = NDArray[np.float32]
Numbering = Callable[[Ids], NDArray[np.int32]]


@dataclass(frozen=True)
class Surface:
    """positions (n, 3) float32, normalised frame; faces (m, 3) int32; cell: the grid's spacing."""

    positions: Floats
    faces: NDArray[np.int32]
    cell: float


def extract(network: Network, resolution: int) -> Surface:
    """The zero set of the SDF network in the cube [-1.02, 1.02]^3 of the normalised frame.

    `resolution` is the least number of cells along an edge of the cube: it is rounded up, by an
    eighth at most, so that blocks halve evenly and none reaches out of the cube.
    """
    root, levels, cell = _grid(resolution)
    kept = _surface_blocks(network, root, levels, cell)
    blocks, values, points = _sampled(network, kept, root * 2**levels, cell)
    places, axes, faces = _polygons(values, points)
    crossings = _crossings(blocks, values.ravel(), places, axes, cell)
    return Surface(onto_surface(network, crossings, cell / 2, NEWTON_STEPS), faces, cell)


def near_surface(network: Network, resolution: int) -> tuple[Floats, float]:
    """Centres (b, 3) of the blocks that `extract` would look into, and the blocks' size."""
    root, levels, cell = _grid(resolution)
    blocks = _surface_blocks(network, root, levels, cell)
    return _centres(blocks, BLOCK * cell), BLOCK * cell


def _grid(resolution: int) -> tuple[int, int, float]:
    """Blocks along the cube at first, how often they are halved, and the size of a cell."""
    across = -(-resolution // BLOCK)
    levels = max(0, int(np.ceil(np.log2(across / ROOT))))
    root = -(-across // 2**levels)
    return root, levels, 2 * LIMIT / (root * 2**levels * BLOCK)


def _surface_blocks(network: Network, root: int, levels: int, cell: float) -> Ids:
    """Integer coordinates (b, 3) of the blocks of BLOCK^3 cells that may hold surface.

    A block is halved and kept while the field at its centre is no larger than it may become over
    half the block's diagonal. How fast it may grow is measured anew among the blocks of each level:
    far from the surface a fitted field is steeper than near it.
    """
    blocks = _lattice(root)
    for level in range(levels, -1, -1):
        size = cell * BLOCK * 2**level
        centres = _centres(blocks, size)
        if level == levels:
            bound = _steepness(network, centres)
        distance = np.abs(evaluate(network, centres)[:, 0])
        near = distance <= bound * size * np.sqrt(3) / 2
        blocks = blocks[near]
        if level:
            bound = _steepness(network, centres[near])
            blocks = (2 * blocks[:, None] + CORNERS).reshape(-1, 3)
    return blocks


def _centres(blocks: Ids, size: float) -> Floats:
    return ((blocks + 0.5) * size - LIMIT).astype(np.float32)


def _lattice(count: int) -> Ids:
    """All integer points of a cube, (count^3, 3), the last axis fastest."""
    return np.indices((count,) * 3).reshape(3, -1).T.astype(np.int64)


def _steepness(network: Network, points: Floats) -> float:
    """A bound on the field's slope round the points: 1 for an SDF, for a fitted one only nearly."""
    slopes = np.linalg.norm(gradient(network, points)[1], axis=1)
    return float(1.25 * np.percentile(slopes, 99, method="higher")) if len(slopes) else 1.0


def _sampled(
    network: Network, blocks: Ids, across: int, cell: float
) -> tuple[Ids, Floats, NDArray[np.int32]]:
    """The blocks and their `_block_values`, with the blocks that were left out by mistake.

    Where the field is steeper than measured its surface may leave the kept blocks: it would end
    there in a hole.
    """
    own = _own_values(network, blocks, cell)
    while True:
        number_of = _numbered(blocks, across)
        values, points = _block_values(network, blocks, own, number_of, cell)
        more = _left_out(blocks, values, number_of, across)
        if len(more) == 0:
            return blocks, values, points
        blocks = np.concatenate([blocks, more])
        own = np.concatenate([own, _own_values(network, more, cell)])


def _left_out(blocks: Ids, values: Floats, number_of: Numbering, across: int) -> Ids:
    """Blocks (b, 3) of the cube that are not there, and lie behind a face that is crossed."""
    inside = values < 0
    beyond = []
    for axis in range(3):
        for side, step in ((0, -1), (BLOCK, 1)):
            face = inside.take(side, axis=axis + 1).reshape(len(blocks), (BLOCK + 1) ** 2)
            neighbours = blocks[face.any(axis=1) & ~face.all(axis=1)]
            neighbours[:, axis] += step
            place = neighbours[:, axis]
            beyond.append(neighbours[(place >= 0) & (place < across)])
    wanted = np.concatenate(beyond)
    return np.unique(wanted[number_of(wanted) < 0], axis=0)


def _block_values(
    network: Network, blocks: Ids, own: Floats, number_of: Numbering, cell: float
) -> tuple[Floats, NDArray[np.int32]]:
    """The field at each block's (BLOCK + 1)^3 grid points, and their numbers: (b, 3, 3, 3) each.

    A block owns its BLOCK^3 lower points and takes the others from its upper neighbours, so that a
    point shared by several blocks has one value, bit for bit, or the surface would crack.
    """
    own_points = np.arange(own.size, dtype=np.int32).reshape(own.shape)
    values = np.empty((len(blocks), *(BLOCK + 1,) * 3), np.float32)
    points = np.empty(values.shape, np.int32)
    values[:, :BLOCK, :BLOCK, :BLOCK] = own
    points[:, :BLOCK, :BLOCK, :BLOCK] = own_points
    absent = np.zeros(values.shape, np.bool_)
    for corner in CORNERS[1:]:
        owners = number_of(blocks + corner)
        rim = (slice(None), *(slice(BLOCK, None) if c else slice(BLOCK) for c in corner))
        theirs = (slice(None), *(slice(1) if c else slice(None) for c in corner))
        values[rim] = own[theirs][owners]
        points[rim] = own_points[theirs][owners]
        absent[rim] = (owners < 0)[:, None, None, None]
    values[absent], rim_points = _rim_values(network, blocks, absent, cell)
    points[absent] = own.size + rim_points
    return values, points


def _numbered(blocks: Ids, across: int) -> Numbering:
    """What gives the numbers of blocks by their coordinates, -1 where none was kept.

    A table of the cube holds octets of blocks: one of single blocks takes gigabytes at 2048 cells.
    """
    octets = np.full((across // 2 + 1,) * 3, -1, np.int32)
    octets[tuple(blocks.T >> 1)] = np.arange(len(blocks))
    members = np.full((len(blocks), 2, 2, 2), -1, np.int32)
    members[octets[tuple(blocks.T >> 1)], *(blocks.T & 1)] = np.arange(len(blocks))

    def number_of(wanted: Ids) -> NDArray[np.int32]:
        octet = octets[tuple(wanted.T >> 1)]
        return np.where(octet < 0, np.int32(-1), members[octet, *(wanted.T & 1)])

    return number_of


def _own_values(network: Network, blocks: Ids, cell: float) -> Floats:
    """The field at the points that blocks own, (b, 2, 2, 2)."""
    inner = _lattice(BLOCK)
    own = np.empty((len(blocks), BLOCK**3), np.float32)
    for start in range(0, len(blocks), TOGETHER):
        some = blocks[start : start + TOGETHER, None] * BLOCK + inner
        own[start : start + TOGETHER] = _field(network, some.reshape(-1, 3), cell).reshape(
            -1, BLOCK**3
        )
    return own.reshape(-1, *(BLOCK,) * 3)


def _rim_values(
    network: Network, blocks: Ids, absent: NDArray[np.bool_], cell: float
) -> tuple[Floats, Ids]:
    """The field at the rim points that no kept block owns, each evaluated once; their numbers."""
    block, *offset = np.nonzero(absent)
    keys = _key(blocks[block] * BLOCK + np.stack(offset, axis=1))
    unique, inverse = np.unique(keys, return_inverse=True)
    return _field(network, _unkey(unique), cell)[inverse], inverse


def _field(network: Network, grid: Ids, cell: float) -> Floats:
    return evaluate(network, (grid * cell - LIMIT).astype(np.float32))[:, 0]


def _key(grid: Ids) -> Ids:
    return grid[..., 0] << 40 | grid[..., 1] << 20 | grid[..., 2]


def _unkey(keys: Ids) -> Ids:
    mask = (1 << 20) - 1
    return np.stack([keys >> 40, keys >> 20 & mask, keys & mask], axis=-1)


def _polygons(
    values: Floats, points: NDArray[np.int32]
) -> tuple[Ids, NDArray[np.int8], NDArray[np.int32]]:
    """The crossed grid edges: where their low ends are in `values` (n,), their axes; faces (m, 3).

    An edge is known by the number of its low point, so that no sorting is needed to find the same
    edge in several cells.
    """
    cases = _cases(values)
    cells = np.flatnonzero((cases > 0) & (cases < 255))
    owners, triangles = polygonise(cases[cells])
    lows, axes = np.array([low for low, _ in EDGES]), np.array([axis for _, axis in EDGES], np.int8)
    places = _first_corners(cells)[owners, None] + (CORNERS @ STRIDES)[lows[triangles]]
    edges = 3 * points.ravel()[places] + axes[triangles]
    numbers = np.zeros(3 * (int(points.max(initial=0)) + 1), np.int32)
    numbers[edges] = 1
    crossed = np.flatnonzero(numbers)
    numbers[crossed] = np.arange(len(crossed))
    faces = numbers[edges]
    first = np.empty(len(crossed), np.int64)
    first[faces] = places
    return first, (crossed % 3).astype(np.int8), faces


def _cases(values: Floats) -> NDArray[np.uint8]:
    """The case of every cell of every block, (b * BLOCK^3,)."""
    inside = values < 0
    cases = np.zeros((len(values), *(BLOCK,) * 3), np.uint8)
    for i, corner in enumerate(CORNERS):
        window = (slice(None), *(slice(c, c + BLOCK) for c in corner))
        cases |= inside[window].astype(np.uint8) << i
    return cases.ravel()


def _first_corners(cells: Ids) -> Ids:
    """Where cells' lowest corners are in the values of all blocks."""
    block, inner = np.divmod(cells, BLOCK**3)
    return block * (BLOCK + 1) ** 3 + (_lattice(BLOCK) @ STRIDES)[inner]


def _crossings(
    blocks: Ids, values: Floats, places: Ids, axes: NDArray[np.int8], cell: float
) -> Floats:
    """Where the field crosses zero along each edge, if it were linear."""
    low, high = values[places], values[places + STRIDES[axes]]
    block, inner = np.divmod(places, (BLOCK + 1) ** 3)
    grid = (blocks[block] * BLOCK + _lattice(BLOCK + 1)[inner]).astype(np.float64)
    grid[np.arange(len(grid)), axes] += np.clip(low / (low - high), CLEARANCE, 1 - CLEARANCE)
    return (grid * cell - LIMIT).astype(np.float32)
