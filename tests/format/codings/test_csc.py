from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from nispcodec.format.codings import csc, csr
from nispcodec.format.codings.reader import Reader


@given(hnp.arrays(np.int32, st.tuples(st.integers(1, 6), st.integers(1, 6)), fill=st.just(0)))
def test_it_is_csr_of_the_transposed_matrix(matrix: np.ndarray[Any, Any]) -> None:
    payload = csc.encode(matrix)
    rows, columns = matrix.shape
    reader = Reader("NETS", payload)
    np.testing.assert_array_equal(csr.decode(reader, (columns, rows), symbols=True), matrix.T)
    reader.finish()
    assert csr.encode(matrix.T.copy()) == payload
