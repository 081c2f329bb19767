"""Errors keep what they say on the way from one process to another."""

from __future__ import annotations

import pickle

from nispcodec.core.errors import FormatError


def test_a_format_error_survives_pickling() -> None:
    error = FormatError("META", "version", 1, 7)
    error.file = "a.nisp"
    back = pickle.loads(pickle.dumps(error))
    assert str(back) == "a.nisp: section META, field version: expected 1, found 7"
    assert (back.section, back.field, back.expected, back.found) == ("META", "version", 1, 7)
