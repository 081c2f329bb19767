"""Every way of failing is a `FormatError` at the right place; nothing else ever escapes."""

from __future__ import annotations

import pytest

from nispcodec.core.errors import FormatError
from nispcodec.format import inspect, unpack
from tests.conformance.builder import Malformed, container
from tests.conformance.malformed import all_malformed, rows

ALL = list(all_malformed())


def test_the_file_they_are_all_made_from_is_valid() -> None:
    assert unpack(container(rows())).networks["sdf"].spec.hidden == (2,)


def test_names_are_unique() -> None:
    assert len({case.name for case in ALL}) == len(ALL)


@pytest.mark.parametrize("case", ALL, ids=[case.name for case in ALL])
def test_refused_at_the_right_place(case: Malformed) -> None:
    with pytest.raises(FormatError) as caught:
        unpack(case.data)
    assert (caught.value.section, caught.value.field) == (case.section, case.field)
    assert str(caught.value.expected)
    with pytest.raises(FormatError):
        inspect(case.data)
