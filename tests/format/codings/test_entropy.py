from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from nispcodec.core.errors import FormatError
from nispcodec.format.codings import entropy, rans
from nispcodec.format.codings.entropy import SymbolRun
from nispcodec.format.codings.reader import Reader

RUNS = st.lists(
    hnp.arrays(np.int32, st.integers(1, 60), elements=st.integers(-700, 700)),
    min_size=1,
    max_size=4,
)


def read(
    runs: list[SymbolRun], counts: list[int]
) -> tuple[list[entropy.RunHeader], list[entropy.Coded]]:
    data = b"".join(run.header() for run in runs) + entropy.encode(runs)
    reader = Reader("NETS", data)
    headers = [entropy.read_header(reader, count, symbols=True) for count in counts]
    return headers, entropy.decode(reader, headers)


@given(RUNS)
@settings(max_examples=50)
def test_the_bits_told_when_reading_are_those_told_when_writing(
    values: list[np.ndarray[Any, Any]],
) -> None:
    """But for the bits that fill a byte, and a model's share of zeros, which is in the header."""
    runs = [SymbolRun(each) for each in values]
    for run, header, (_, cost) in zip(
        runs, *read(runs, [len(each) for each in values]), strict=True
    ):
        zeros = 8 if header.model and header.model.zeros else 0
        assert -1e-6 <= 8 * run.streamed() - cost - zeros < 8


def test_zeros_alone_take_nothing_but_the_word_that_they_are_zeros() -> None:
    run = SymbolRun(np.zeros(1000, np.int32))
    assert (run.header(), entropy.encode([run]), run.streamed()) == (b"\0", b"", 0)
    _, ((values, cost),) = read([run], [1000])
    assert (values == 0).all()
    assert (values.shape, cost) == ((1000,), 0)
    assert values.dtype == np.int32


@given(RUNS)
@settings(max_examples=30)
def test_tokens_lie_within_the_scale(values: list[np.ndarray[Any, Any]]) -> None:
    for each in values:
        starts, frequencies = SymbolRun(each).tokens()
        assert len(starts) == len(frequencies) == (len(each) if each.any() else 0)
        for start, frequency in zip(starts, frequencies, strict=True):
            assert 0 <= start < start + frequency <= rans.SCALE


def test_a_magnitude_above_its_limit_is_refused() -> None:
    """A cell of two magnitudes, of which the header allows the lower alone."""
    run = SymbolRun(np.array([514, 1], np.int32))
    data = bytearray(run.header() + entropy.encode([run]))
    assert data[:2] == b"\x82\x04"
    data[0] = 0x81
    reader = Reader("NETS", bytes(data))
    header = entropy.read_header(reader, 2, symbols=True)
    with pytest.raises(FormatError, match="magnitude: expected at most 513, found 514"):
        entropy.decode(reader, [header])
