from __future__ import annotations

import pytest

from nispcodec.infer.parallel import on_every_core


def test_every_part_runs_once_even_within_another() -> None:
    done: list[int] = []
    on_every_core(lambda part: on_every_core(done.append, [part, part + 100]), range(20))
    assert sorted(done) == [*range(20), *range(100, 120)]


def test_an_error_comes_back() -> None:
    with pytest.raises(ZeroDivisionError):
        on_every_core(lambda part: 1 // part, [1, 0, 2, 3])
