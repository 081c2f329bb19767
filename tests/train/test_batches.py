"""Batches: rounds of all samples; hard ones as often as they are hard."""

from __future__ import annotations

import numpy as np

from nispcodec.train.batches import Batches


def batches(count: int, size: int) -> Batches:
    return Batches(count, size, np.random.default_rng(0))


def test_a_round_has_every_sample_at_most_once_and_leaves_less_than_a_batch_out() -> None:
    rows = batches(103, 10).take(10)
    assert rows.shape == (10, 10)
    assert rows.dtype == np.int32
    assert len(np.unique(rows)) == 100
    assert (rows >= 0).all()
    assert (rows < 103).all()


def test_rounds_differ() -> None:
    first, second = np.split(batches(100, 10).take(20), 2)
    assert not np.array_equal(first, second)
    assert np.array_equal(np.sort(first, axis=None), np.sort(second, axis=None))


def test_fewer_samples_than_a_batch_are_one_batch() -> None:
    assert batches(7, 10).take(3).shape == (3, 7)


def test_it_does_not_matter_how_many_are_taken_at_a_time() -> None:
    one, other = batches(50, 8), batches(50, 8)
    apart = np.concatenate([one.take(1) for _ in range(9)])
    assert np.array_equal(apart, other.take(9))


def test_every_other_sample_is_a_hard_one_by_its_hardness() -> None:
    hardness = np.zeros(1000, dtype=np.float32)
    hardness[[3, 7]] = 1.0, 3.0
    found = batches(1000, 100)
    found.take(1)
    found.prefer(hardness)
    rows = found.take(20)
    assert np.isin(rows[:, 1::2], [3, 7]).all()
    assert len(np.unique(rows[:, ::2])) == 1000
    assert abs((rows[:, 1::2] == 7).mean() - 0.75) < 0.05


def test_when_nothing_is_hard_any_more_all_are_alike() -> None:
    found = batches(100, 10)
    found.prefer(np.eye(1, 100, dtype=np.float32)[0])
    found.prefer(np.zeros(100, dtype=np.float32))
    assert len(np.unique(found.take(10))) == 100
