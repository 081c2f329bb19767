from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.errors import FormatError
from nispcodec.format.codings import csr
from nispcodec.format.codings.reader import Reader


def test_an_empty_matrix_is_a_count_of_zero_for_each_row() -> None:
    assert csr.encode(np.zeros((5, 3), np.int32)) == bytes(5) + b"\x03"


def test_every_value_has_its_row_and_column() -> None:
    matrix = np.zeros((3, 4), np.float32)
    matrix[2, 1], matrix[2, 3], matrix[0, 0] = 0.5, -1, 2
    reader = Reader("NETS", b"\x01\x00\x02" + b"\x00\x01\x01" + b"\x02\x00\x40\x00\x38\x00\xbc")
    decoded = csr.decode(reader, (3, 4), symbols=False)
    reader.finish()
    np.testing.assert_array_equal(decoded, matrix)


def test_more_values_than_a_row_holds_are_refused() -> None:
    with pytest.raises(FormatError, match="row_count: expected at most 2, found 3"):
        csr.decode(Reader("NETS", b"\x03" + bytes(9)), (1, 2), symbols=True)
    with pytest.raises(FormatError, match="column: expected below 2, found 2"):
        csr.decode(Reader("NETS", b"\x02\x00\x01\x03\x07\x07"), (1, 2), symbols=True)
