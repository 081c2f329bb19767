"""The field on blocks: one value and one number for each grid point, whoever asks for it."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.extract.grid import BLOCK, CUBE, Grid
from nispcodec.infer.evaluate import evaluate
from tests import tiny

ACROSS = 9
CELL = 2 * CUBE / (ACROSS * BLOCK)


def some_blocks(share: float) -> np.ndarray:
    everything = np.indices((ACROSS,) * 3).reshape(3, -1).T.astype(np.int64)
    rng = np.random.default_rng(0)
    return rng.permutation(everything)[: int(share * len(everything))]


@pytest.mark.parametrize("share", [0.01, 0.3, 1.0])
def test_a_point_has_one_number_and_one_value(share: float) -> None:
    network, blocks = tiny.sphere(), some_blocks(share)
    grid = Grid(network, ACROSS, CELL)
    first, second = (grid.sampled(part) for part in np.array_split(blocks, 2))
    values, numbers = (np.concatenate(pair).ravel() for pair in zip(first, second, strict=True))
    places = np.indices((BLOCK + 1,) * 3).reshape(3, -1).T
    coordinates = (blocks[:, None] * BLOCK + places).reshape(-1, 3)
    expected = evaluate(network, (coordinates * CELL - CUBE).astype(np.float32))[:, 0]
    assert np.allclose(values, expected, atol=1e-4)
    by_place = np.unique(coordinates, axis=0, return_inverse=True)[1].ravel()
    pairs = np.unique(np.stack([by_place, numbers], axis=1), axis=0)
    assert len(pairs) == len(np.unique(by_place)) == len(np.unique(numbers))
    alike = np.zeros(numbers.max() + 1, np.float32)
    alike[numbers] = values
    assert np.array_equal(alike[numbers], values)


def test_what_was_sampled_is_known() -> None:
    grid, blocks = Grid(tiny.sphere(), ACROSS, CELL), some_blocks(1.0)
    assert not grid.has_sampled(blocks[:5]).any()
    grid.sampled(blocks[:300])
    assert grid.has_sampled(blocks[:300]).all()
    assert not grid.has_sampled(blocks[300:]).any()
