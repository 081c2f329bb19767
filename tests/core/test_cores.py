from __future__ import annotations

from threadpoolctl import threadpool_info

from nispcodec.core.cores import at_most, cores
from nispcodec.infer.parallel import on_cores


def test_limits_hold_within_their_block_alone() -> None:
    before = cores()
    with at_most(1):
        assert cores() == 1
        with at_most(0):
            assert cores() == 1
    with at_most(10**6):
        assert cores() == before
    assert cores() == before


def test_blas_is_limited_too() -> None:
    before = [each["num_threads"] for each in threadpool_info()]
    with on_cores(1):
        assert cores() == 1
        assert {each["num_threads"] for each in threadpool_info()} == {1}
    assert [each["num_threads"] for each in threadpool_info()] == before
    with on_cores(0):
        assert [each["num_threads"] for each in threadpool_info()] == before
