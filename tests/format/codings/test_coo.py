from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.errors import FormatError
from nispcodec.format.codings import coo
from nispcodec.format.codings.reader import Reader


def test_only_what_is_not_zero_takes_bytes() -> None:
    """A count, the kind of number; for each value a row step, a gap and the value itself."""
    for count in range(4):
        matrix = np.zeros((9, 9), np.int32)
        matrix.ravel()[5 : 5 + 9 * count : 9] = 7
        assert len(coo.encode(matrix)) == 1 + 1 + 3 * count


@pytest.mark.parametrize(
    ("payload", "text"),
    [
        (b"\x05", "count: expected at most 4, in the fewest bytes, found 5"),
        (b"\x02\x01\x01\x00\x00\x03\x07\x07", "row: expected below 2, found 2"),
        (b"\x02\x00\x00\x01\x00\x03\x07\x07", "column: expected below 2, found 2"),
    ],
)
def test_places_outside_the_matrix_are_refused(payload: bytes, text: str) -> None:
    with pytest.raises(FormatError, match=text):
        coo.decode(Reader("NETS", payload), (2, 2), symbols=True)
