from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from nispcodec.core.document import ChartTable, Frame
from nispcodec.encode.single_precision import short_frame, short_uv_map

NUMBERS = st.floats(-1e6, 1e6)
POSITIVE = st.floats(1e-6, 1e6)
SHARES = st.sampled_from([0.0, 1e-9, 1e-7, 1e-3])


def held(before: float, after: float, limit: float) -> bool:
    """Single precision where that is near enough, else the number itself."""
    single = float(np.float32(before))
    return after == (single if abs(single - before) <= limit else before)


@given(st.tuples(NUMBERS, NUMBERS, NUMBERS), POSITIVE, SHARES)
def test_no_number_of_a_frame_moves_by_more_than_the_share_of_the_radius(
    center: tuple[float, float, float], radius: float, share: float
) -> None:
    short = short_frame(Frame(center, radius), share)
    pairs = zip((*center, radius), (*short.center, short.radius), strict=True)
    assert all(held(before, after, share * radius) for before, after in pairs)


@given(st.tuples(NUMBERS, NUMBERS), st.tuples(POSITIVE, POSITIVE), SHARES)
def test_no_number_of_a_uv_map_moves_by_more_than_the_share_of_the_smaller_scale(
    offset: tuple[float, float], scale: tuple[float, float], share: float
) -> None:
    table = ChartTable(np.array([0, 1], np.int32), np.array([True, False]), offset, scale, True)
    short = short_uv_map(table, share)
    pairs = zip((*offset, *scale), (*short.uv_offset, *short.uv_scale), strict=True)
    assert all(held(before, after, share * min(scale)) for before, after in pairs)
    assert short.materials is table.materials
    assert short.has_uv is table.has_uv
    assert short.openings


def test_an_asset_far_from_the_origin_keeps_its_place() -> None:
    """A small thing in the units of a map."""
    frame = Frame((4_500_000.123, 0.1, 0.0), 0.5)
    short = short_frame(frame, 1e-7)
    assert short.center[0] == frame.center[0]
    assert short.center[1] == float(np.float32(0.1)) != 0.1
