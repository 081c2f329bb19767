from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nispcodec.core.errors import FormatError
from nispcodec.format.codings import frequency_model
from nispcodec.format.codings.frequency_model import FrequencyModel
from nispcodec.format.codings.rans import SCALE
from nispcodec.format.codings.reader import Reader
from nispcodec.format.constants import MAX_CELLS

MODELS = st.builds(FrequencyModel, st.integers(0, 31), st.integers(0, 3), st.integers(0, 255))


@given(MODELS, st.integers(1, MAX_CELLS))
def test_every_token_can_be_written_and_none_is_favored_by_its_sign(
    model: FrequencyModel, cells: int
) -> None:
    starts = model.starts(cells)
    frequencies = np.diff(starts)
    assert (len(frequencies), starts[0], starts[-1]) == (2 * cells + 1, 0, SCALE)
    assert frequencies.min() >= 1
    np.testing.assert_array_equal(frequencies, frequencies[::-1])
    assert (np.diff(frequencies[cells + 1 :]) <= 0).all()


@given(MODELS.filter(lambda model: model.zeros > 0), st.integers(1, MAX_CELLS))
def test_a_share_of_zeros_is_kept_whatever_the_curve(model: FrequencyModel, cells: int) -> None:
    """Every other token has 1 of the scale in any case; what is rounded off goes to the zeros."""
    frequencies = np.diff(model.starts(cells))
    share = (frequencies[cells] - 1) / (SCALE - 2 * cells - 1)
    slack = (2 * cells + 1) / (SCALE - 2 * cells - 1)
    assert share == pytest.approx(model.zeros / 256, abs=slack)


@given(MODELS)
def test_a_model_takes_one_byte_or_two(model: FrequencyModel) -> None:
    data = model.encode()
    assert len(data) == (2 if model.zeros else 1)
    reader = Reader("NETS", data)
    assert frequency_model.decode(reader) == model
    reader.finish()


def test_a_share_of_no_zeros_is_refused() -> None:
    with pytest.raises(FormatError, match="zeros: expected 1 to 255, found 0"):
        frequency_model.decode(Reader("NETS", b"\x80\x00"))


def test_a_narrow_curve_is_found_for_small_values_and_a_wide_one_for_even_ones() -> None:
    cells = np.arange(65)
    narrow, _ = frequency_model.fit((10_000 * 0.5**cells).astype(np.int64))
    wide, _ = frequency_model.fit(np.full(65, 1000))
    assert narrow.narrowness > wide.narrowness + 5
