"""Counts are told in the singular and in the plural."""

from __future__ import annotations

import pytest

from nispcodec.core.counted import counted
from nispcodec.extract.components import ExtractionReport


@pytest.mark.parametrize(
    ("number", "noun", "expected"),
    [
        (0, "face", "0 faces"),
        (1, "face", "1 face"),
        (1200, "face", "1,200 faces"),
        (1, "unreferenced vertex", "1 unreferenced vertex"),
        (2, "unreferenced vertex", "2 unreferenced vertices"),
    ],
)
def test_a_count_agrees_with_its_noun(number: int, noun: str, expected: str) -> None:
    assert counted(number, noun) == expected


def test_dropped_noise_is_counted() -> None:
    assert ExtractionReport(8, 1, 1, 1).warnings == ("1 spurious component, 1 face, dropped",)
    assert ExtractionReport(8, 1, 2, 40).warnings == ("2 spurious components, 40 faces, dropped",)
