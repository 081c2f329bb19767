from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nispcodec.core.errors import FormatError
from nispcodec.format import steps
from nispcodec.format.codings.reader import Reader
from nispcodec.format.constants import STEPS

SINGLES = st.floats(2.0**-149, 2.0**127, width=32)
# Eight steps an octave, from 2^-27 to less than 2^5.
BYTES = st.integers(0, 255).map(lambda byte: (8 + byte % 8) / 8 * 2.0 ** (byte // 8 - 27))
NONE = np.zeros(0, np.int64)


@given(st.one_of(SINGLES, BYTES), st.one_of(st.none(), SINGLES, BYTES))
def test_any_step_comes_back_from_the_form_that_it_takes(step: float, before: float | None) -> None:
    form, data = steps.encode("sdf", step, before, NONE, 0)
    assert form in STEPS
    reader = Reader("NETS", data)
    assert steps.decode(reader, form, before) == step
    reader.finish()


@pytest.mark.parametrize(
    ("step", "before", "form", "size"),
    [
        (0.1, 0.1, "same", 0),
        (0.1, float(np.float32(0.1)), "same", 0),
        (0.125, 0.25, "byte", 1),
        (31.0, 30.0, "float16", 2),
        (2.0**-28, None, "float32", 4),
        (1.125, None, "byte", 1),
        (1.0625, None, "float16", 2),
        (0.1, 0.2, "float32", 4),
    ],
)
def test_a_form_takes_as_few_bytes_as_it_can(
    step: float, before: float | None, form: str, size: int
) -> None:
    found, data = steps.encode("sdf", step, before, NONE, 0)
    assert (found, len(data)) == (form, size)


@given(BYTES, st.integers(1, 3), st.data())
def test_row_shifts_follow_a_step_of_one_byte(step: float, width: int, data: st.DataObject) -> None:
    assert steps.has_row_shifts(step)
    shifts = data.draw(st.lists(st.integers(0, 2**width - 1), min_size=1, max_size=9))
    form, written = steps.encode("sdf", step, step, np.array(shifts), width)
    assert form == f"rows{width}"
    assert len(written) == 1 + -(-len(shifts) * width // 8)
    reader = Reader("NETS", written)
    assert steps.decode(reader, form, None) == step
    assert steps.decode_row_shifts(reader, form, len(shifts)).tolist() == shifts
    reader.finish()


@pytest.mark.parametrize("form", ["byte", "float16", "float32", "same"])
def test_without_row_shifts_all_are_zero(form: str) -> None:
    reader = Reader("NETS", b"rest")
    assert steps.decode_row_shifts(reader, form, 3).tolist() == [0, 0, 0]
    assert reader.position == 0


@pytest.mark.parametrize("step", [0.0, -1.0, np.inf, np.nan, 1e-60])
def test_a_step_is_a_positive_number_in_single_precision(step: float) -> None:
    assert not steps.has_row_shifts(step)
    with pytest.raises(FormatError, match=r"sdf\.step: expected a positive float32, found"):
        steps.encode("sdf", step, None, NONE, 0)


@pytest.mark.parametrize(
    ("form", "data", "text"),
    [
        ("float16", b"\x00\x7c", "expected a positive number, found inf"),
        ("float32", b"\x00\x00\x80\xbf", "expected a positive number, found -1.0"),
        ("float32", b"\x00\x00\x80", "expected 4 bytes, found 3 bytes left"),
        ("same", b"", "expected a step in the record before, found none"),
    ],
)
def test_steps_that_are_refused_when_read(form: str, data: bytes, text: str) -> None:
    with pytest.raises(FormatError, match=f"step: {text}"):
        steps.decode(Reader("NETS", data), form, None)
