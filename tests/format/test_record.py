from __future__ import annotations

from typing import Any

import pytest

from nispcodec.core.errors import FormatError
from nispcodec.format.record import (
    Record,
    check_file_name,
    check_text,
    located,
    number,
    sparse,
)


def record(**values: Any) -> Record:
    return Record("META", "thing", {int(key[1:]): value for key, value in values.items()})


def test_a_field_is_taken_once_and_what_is_left_is_an_error() -> None:
    read = record(k1=5, k2="a")
    assert read.take(1, "size", int) == 5
    assert (1 in read, 2 in read) == (False, True)
    with pytest.raises(FormatError, match=r"thing\.keys: expected only known keys, found 2"):
        read.finish()
    read.text(2, "name")
    read.finish()


def test_the_record_changes_no_map() -> None:
    values = {1: 5}
    Record("META", "thing", values).take(1, "size", int)
    assert values == {1: 5}


@pytest.mark.parametrize(
    ("value", "kind", "default", "text"),
    [
        (True, int, None, "expected int, found bool"),
        (1, float, None, "expected float, found int"),
        (1, bool, None, "expected bool, found int"),
        (0.5, float, 0.5, "expected absent, being the default, found present"),
        (-0.0, float, 0.0, "expected absent, being the default, found present"),
    ],
)
def test_a_field_is_of_exactly_its_type_and_never_its_default(
    value: Any, kind: type[Any], default: Any, text: str
) -> None:
    with pytest.raises(FormatError, match=rf"section META, field thing\.size: {text}"):
        record(k1=value).take(1, "size", kind, default)


def test_a_field_without_default_must_be_there() -> None:
    assert record().take(1, "size", int, 7) == 7
    with pytest.raises(FormatError, match=r"thing\.size: expected present, found absent"):
        record().take(1, "size", int)


def test_what_is_no_map_is_refused() -> None:
    with pytest.raises(FormatError, match="field thing: expected a map, found list"):
        Record("META", "thing", [])


@pytest.mark.parametrize("value", [[0.5], [0.5, 1], [0.5, True], [0.5, "a"], []])
def test_floats_are_as_many_as_asked_for_and_nothing_else(value: list[Any]) -> None:
    assert record(k1=[0.5, 1.0]).floats(1, "at", 2) == (0.5, 1.0)
    with pytest.raises(FormatError, match=r"thing\.at: expected 2 floats"):
        record(k1=value).floats(1, "at", 2)


@pytest.mark.parametrize("value", [2, 6])
def test_integers_and_members_have_limits(value: int) -> None:
    assert [record(k1=each).integer(1, "n", 3, 5) for each in (3, 5)] == [3, 5]
    with pytest.raises(FormatError, match=rf"thing\.n: expected 3 to 5, found {value}"):
        record(k1=value).integer(1, "n", 3, 5)
    assert record().member(1, "kind", ("a", "b")) == "a"
    assert record(k1=2).member(1, "kind", ("a", "b")) == "b"
    with pytest.raises(FormatError, match=r"thing\.kind: expected 1 to 2, found 0"):
        record(k1=0).member(1, "kind", ("a", "b"))


def test_what_sparse_leaves_out_a_record_gives_back() -> None:
    fields = {1: (0.25, 0.5), 2: (0.5, 0.5), 3: (0.5, None)}
    assert sparse(fields) == {1: 0.25, 3: 0.5}
    read = Record("META", "thing", sparse(fields))
    assert [read.take(key, "n", float, fields[key][1]) for key in fields] == [0.25, 0.5, 0.5]


def test_a_members_number_counts_from_one() -> None:
    assert [number("META", "kind", each, ("a", "b")) for each in "ab"] == [1, 2]
    with pytest.raises(FormatError, match="kind: expected one of a, b, found c"):
        number("META", "kind", "c", ("a", "b"))


@pytest.mark.parametrize("value", ["a\nb", "\0", "\x7f", "\x1b[0m"])
def test_control_characters_are_refused(value: str) -> None:
    check_text("META", "name", "Größe 1 ~")
    with pytest.raises(FormatError, match="name: expected text without control characters"):
        check_text("META", "name", value)


@pytest.mark.parametrize("value", ["", ".", "..", "/a", "a/b", "a\\b", "c:a", "a/.."])
def test_names_that_lead_out_of_the_folder_are_refused(value: str) -> None:
    check_file_name("META", "name", "...")
    with pytest.raises(FormatError, match="name: expected a bare file name"):
        check_file_name("META", "name", value)


def test_an_error_of_the_core_gets_section_and_path() -> None:
    with pytest.raises(FormatError) as caught, located("NETS", "sdf"):
        raise FormatError("network", "w0", "more", 0)
    assert str(caught.value) == "section NETS, field sdf.w0: expected more, found 0"
    with pytest.raises(KeyError), located("NETS", "sdf"):
        raise KeyError
