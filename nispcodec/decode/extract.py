"""From the SDF network to a triangle mesh, with work that grows with the surface.

Blocks of the cube are kept, coarse to fine, while the field says that the surface may pass through
them; the field is then sampled on the grid points of the kept blocks only, polygonised, and the
vertices are moved onto the zero set.
"""

from __future__ import annotations

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
BLOCK = 4
ROOT = 16
NEWTON_STEPS = 2
# Vertices keep this share of a cell from grid points, where several would coincide.
CLEARANCE = 0.01

Ids = NDArray[np.int64]
Floats = NDArray[np.float32]


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
    blocks = _surface_blocks(network, root, levels, cell)
    values = _block_values(network, blocks, root * 2**levels, cell)
    edges, ends, faces = _polygons(blocks, values)
    crossings = _crossings(edges, ends, cell)
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


def _block_values(network: Network, blocks: Ids, across: int, cell: float) -> Floats:
    """The field at each block's (BLOCK + 1)^3 grid points: (b, 5, 5, 5) float32.

    A block owns its BLOCK^3 lower points and takes the others from its upper neighbours, so that a
    point shared by several blocks has one value, bit for bit, or the surface would crack.
    """
    numbers = np.full((across + 1,) * 3, -1, np.int32)
    numbers[tuple(blocks.T)] = np.arange(len(blocks))
    inner = _lattice(BLOCK)
    own = _field(network, (blocks[:, None] * BLOCK + inner).reshape(-1, 3), cell)
    own = own.reshape(-1, *(BLOCK,) * 3)
    values = np.empty((len(blocks), *(BLOCK + 1,) * 3), np.float32)
    values[:, :BLOCK, :BLOCK, :BLOCK] = own
    absent = np.zeros(values.shape, np.bool_)
    for corner in CORNERS[1:]:
        owners = numbers[tuple((blocks + corner).T)]
        rim = (slice(None), *(slice(BLOCK, None) if c else slice(BLOCK) for c in corner))
        theirs = (slice(None), *(slice(1) if c else slice(None) for c in corner))
        values[rim] = own[theirs][owners]
        absent[rim] = (owners < 0)[:, None, None, None]
    _fill(network, blocks, absent, values, cell)
    return values


def _fill(
    network: Network, blocks: Ids, absent: NDArray[np.bool_], values: Floats, cell: float
) -> None:
    """Evaluate the rim points that no kept block owns, each once."""
    block, *offset = np.nonzero(absent)
    keys = _key(blocks[block] * BLOCK + np.stack(offset, axis=1))
    unique, inverse = np.unique(keys, return_inverse=True)
    values[absent] = _field(network, _unkey(unique), cell)[inverse]


def _field(network: Network, grid: Ids, cell: float) -> Floats:
    return evaluate(network, (grid * cell - LIMIT).astype(np.float32))[:, 0]


def _key(grid: Ids) -> Ids:
    return grid[..., 0] << 40 | grid[..., 1] << 20 | grid[..., 2]


def _unkey(keys: Ids) -> Ids:
    mask = (1 << 20) - 1
    return np.stack([keys >> 40, keys >> 20 & mask, keys & mask], axis=-1)


def _polygons(blocks: Ids, values: Floats) -> tuple[Ids, Floats, NDArray[np.int32]]:
    """Crossed grid edges (n, 4: low point, axis), the field at their ends (n, 2), faces (m, 3)."""
    inside = values < 0
    cases = np.zeros((len(blocks), *(BLOCK,) * 3), np.uint8)
    for i, corner in enumerate(CORNERS):
        window = (slice(None), *(slice(c, c + BLOCK) for c in corner))
        cases |= inside[window].astype(np.uint8) << i
    active = np.argwhere((cases > 0) & (cases < 255))
    cells, triangles = polygonise(cases[tuple(active.T)])
    lows = np.array([low for low, _ in EDGES])[triangles]
    axes = np.array([axis for _, axis in EDGES])[triangles]
    grid = (blocks[active[:, 0]] * BLOCK + active[:, 1:])[cells][:, None] + CORNERS[lows]
    keys, first, faces = np.unique(_key(grid) * 3 + axes, return_index=True, return_inverse=True)
    where = (active[:, :1][cells], (active[:, 1:][cells][:, None] + CORNERS[lows]))
    low = where[1].reshape(-1, 3)[first]
    block = np.repeat(where[0], 3)[first]
    axis = axes.ravel()[first]
    high = low + np.eye(3, dtype=np.int64)[axis]
    ends = np.stack([values[block, *low.T], values[block, *high.T]], axis=1)
    edges = np.column_stack([_unkey(keys // 3), axis])
    return edges, ends, faces.reshape(-1, 3).astype(np.int32)


def _crossings(edges: Ids, ends: Floats, cell: float) -> Floats:
    fraction = np.clip(ends[:, 0] / (ends[:, 0] - ends[:, 1]), CLEARANCE, 1 - CLEARANCE)
    grid = edges[:, :3].astype(np.float64)
    grid[np.arange(len(grid)), edges[:, 3]] += fraction
    return (grid * cell - LIMIT).astype(np.float32)
