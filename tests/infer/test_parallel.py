from __future__ import annotations

import time

import pytest

from nispcodec.infer.parallel import parallel_for


def test_every_part_runs_once_even_within_another() -> None:
    done: list[int] = []
    parallel_for(lambda part: parallel_for(done.append, [part, part + 100]), range(20))
    assert sorted(done) == [*range(20), *range(100, 120)]


def test_an_error_comes_back() -> None:
    with pytest.raises(ZeroDivisionError):
        parallel_for(lambda part: 1 // part, [1, 0, 2, 3])


def test_an_error_ends_the_work() -> None:
    done: list[int] = []

    def work(part: int) -> None:
        if part == 0:
            raise ZeroDivisionError
        done.append(part)
        time.sleep(0.01)

    with pytest.raises(ZeroDivisionError):
        parallel_for(work, range(100))
    assert len(done) < 50
