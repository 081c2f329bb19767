from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.errors import FormatError
from nispcodec.format.codings import dense
from nispcodec.format.codings.reader import Reader


def test_rows_follow_each_other() -> None:
    reader = Reader("NETS", b"\x03\x01\x02\x03\xfc\x05\x06")
    assert dense.decode(reader, (2, 3), symbols=True).tolist() == [[1, 2, 3], [-4, 5, 6]]
    reader.finish()


def test_size_is_that_of_the_values_whatever_they_are() -> None:
    for value in (0, 1, -128):
        assert len(dense.encode(np.full((4, 5), value, np.int32))) == 1 + 20


def test_too_few_bytes_are_refused() -> None:
    with pytest.raises(FormatError, match="values: expected 12 bytes, found 11 bytes left"):
        dense.decode(Reader("NETS", b"\x02" + bytes(11)), (2, 3), symbols=False)
