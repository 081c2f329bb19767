"""The field on the grid points of blocks, each point evaluated once however many blocks share it.

Blocks have numbers, in the order in which they are met. A block owns its BLOCK^3 lower points and
takes the others from its upper neighbors, kept or not, so that a point has one value, bit for bit,
or the surface would crack.
"""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import BoolArray, Float32Array, Int32Array, Int64Array
from nispcodec.core.network import Network
from nispcodec.extract.marching_cubes import CORNERS
from nispcodec.infer.evaluate import evaluate
from nispcodec.infer.parallel import parallel_for

# The cube reaches from -CUBE to CUBE in the normalized frame.
CUBE = 1.02
BLOCK = 2
# Blocks, or points, that are dealt with at a time: it bounds memory and stays in a core's cache.
CHUNK = 1 << 15
# The points that a block owns: their numbers, and their places by number.
OWN_POINTS = np.arange(BLOCK**3, dtype=np.int32).reshape((BLOCK,) * 3)
OWN = np.indices(OWN_POINTS.shape).reshape(3, -1).T


def chunks(count: int) -> list[slice]:
    """The parts in which so many blocks or points are dealt with."""
    return [slice(start, start + CHUNK) for start in range(0, count, CHUNK)]


class Grid:
    """`across` blocks of BLOCK^3 cells along each edge of the cube; a cell is `cell` wide."""

    def __init__(self, network: Network, across: int, cell: float) -> None:
        self.across = across
        self._network, self._cell = network, cell
        self._numbering = _Numbering(across)
        self._field = np.empty((0, *(BLOCK,) * 3), np.float32)
        self._known = np.empty(self._field.shape, np.bool_)

    def sampled(self, blocks: Int64Array) -> tuple[Float32Array, Int32Array]:
        """The field at blocks' (BLOCK + 1)^3 grid points, and their numbers: (b, 3, 3, 3) each.

        blocks (b, 3): integer coordinates, each block once.
        """
        owners = [self._numbering(blocks + corner) for corner in CORNERS]
        self._evaluate(owners)
        values = np.empty((len(blocks), *(BLOCK + 1,) * 3), np.float32)
        points = np.empty(values.shape, np.int32)

        def take(part: slice) -> None:
            for corner, owner in zip(CORNERS, owners, strict=True):
                mine = (part, *(slice(BLOCK, None) if c else slice(BLOCK) for c in corner))
                theirs = _taken(corner)
                values[mine] = self._field[:, *theirs][owner[part]]
                points[mine] = BLOCK**3 * owner[part, None, None, None] + OWN_POINTS[theirs]

        parallel_for(take, chunks(len(blocks)))
        return values, points

    def has_sampled(self, blocks: Int64Array) -> BoolArray:
        """Which blocks (n, 3) were already given to `sampled`."""
        number = self._numbering.find(blocks)
        # A block's last point is no other's.
        sampled = number >= 0
        sampled[sampled] = self._known[number[sampled], -1, -1, -1]
        return sampled

    def _evaluate(self, owners: list[Int32Array]) -> None:
        """Asks the network at those points of the owners that no block has asked for before."""
        more = (len(self._numbering.blocks) - len(self._field), *(BLOCK,) * 3)
        self._field = np.concatenate([self._field, np.empty(more, np.float32)])
        self._known = np.concatenate([self._known, np.zeros(more, np.bool_)])
        wanted = np.zeros(self._known.shape, np.bool_)
        for corner, owner in zip(CORNERS, owners, strict=True):
            wanted[:, *_taken(corner)][owner] = True
        asked = np.flatnonzero(wanted & ~self._known)
        self._known |= wanted
        field = self._field.ravel()

        def ask(part: slice) -> None:
            number, inner = np.divmod(asked[part], BLOCK**3)
            grid = self._numbering.blocks[number] * BLOCK + OWN[inner]
            points = (grid * self._cell - CUBE).astype(np.float32)
            field[asked[part]] = evaluate(self._network, points)[:, 0]

        parallel_for(ask, chunks(len(asked)))


def _taken(corner: Int64Array) -> tuple[slice, ...]:
    """Of the points that the neighbor at `corner` owns, those that its lower neighbor takes."""
    return tuple(slice(1) if c else slice(None) for c in corner)


class _Numbering:
    """Numbers of blocks by their coordinates.

    A table of the cube holds octets of blocks: one of single blocks takes gigabytes at 2048 cells.
    """

    def __init__(self, across: int) -> None:
        self.blocks = np.empty((0, 3), np.int64)
        # The first octet stands for all that were not met.
        self._octets = np.zeros((across // 2 + 1,) * 3, np.int32)
        self._members = np.full((1, 2, 2, 2), -1, np.int32)

    def __call__(self, wanted: Int64Array) -> Int32Array:
        """The numbers (n,) of blocks (n, 3), each there once; those not met before get the next."""
        self._add_octets(wanted >> 1)
        numbers = self.find(wanted)
        new = numbers < 0
        numbers[new] = len(self.blocks) + np.arange(new.sum())
        self._members[self._octets[*(wanted[new] >> 1).T], *(wanted[new] & 1).T] = numbers[new]
        self.blocks = np.concatenate([self.blocks, wanted[new]])
        return numbers

    def find(self, wanted: Int64Array) -> Int32Array:
        """The numbers (n,) of blocks (n, 3), -1 for those not met."""
        numbers = np.empty(len(wanted), np.int32)

        def look_up(part: slice) -> None:
            octets = self._octets[*(wanted[part] >> 1).T]
            numbers[part] = self._members[octets, *(wanted[part] & 1).T]

        parallel_for(look_up, chunks(len(wanted)))
        return numbers

    def _add_octets(self, wanted: Int64Array) -> None:
        absent = wanted[self._octets[*wanted.T] == 0]
        # Of those there more than once, the one whose number stays.
        order = np.arange(len(absent))
        self._octets[*absent.T] = order
        absent = absent[self._octets[*absent.T] == order]
        self._octets[*absent.T] = len(self._members) + np.arange(len(absent))
        unmet = np.full((len(absent), 2, 2, 2), -1, np.int32)
        self._members = np.concatenate([self._members, unmet])
