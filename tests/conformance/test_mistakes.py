"""The files tell a reader with a mistake from one without."""

from __future__ import annotations

from functools import cache

import pytest

from tests.conformance.independent import Reader
from tests.conformance.mistakes import MISTAKES, Mistake, changed_reader, is_caught


@cache
def is_clean(stem: str) -> bool:
    """Whether a file has nothing against the reader as it is; many mistakes share a file."""
    return not is_caught(Reader, stem)


def test_there_are_many() -> None:
    assert len(MISTAKES) >= 230


@pytest.mark.parametrize("name", MISTAKES)
def test_a_file_catches_it(name: str) -> None:
    mistake = MISTAKES[name]
    assert is_caught(changed_reader(mistake), mistake.caught_by)
    assert is_clean(mistake.caught_by)


def test_a_mistake_that_changes_nothing_is_an_error() -> None:
    with pytest.raises(ValueError, match="in no text, expected one place"):
        changed_reader(Mistake("nowhere to be found", "", "uv-map"))
