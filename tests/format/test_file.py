from __future__ import annotations

from pathlib import Path

import pytest

from nispcodec.core.errors import FormatError, NispError
from nispcodec.format import pack
from nispcodec.format.file import read
from tests.format.documents import assert_same, full


@pytest.mark.parametrize("kind", [str, Path])
def test_a_document_comes_back_from_its_file(tmp_path: Path, kind: type[str | Path]) -> None:
    path = tmp_path / "a.nisp"
    path.write_bytes(pack(full()))
    assert_same(read(kind(path)), full())


def test_a_malformed_file_is_named_and_its_place_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "cut.nisp"
    path.write_bytes(pack(full())[:-1])
    with pytest.raises(FormatError) as caught:
        read(path)
    assert str(caught.value).startswith(f"{path}: section ZZZZ, field stored_length: expected ")
    assert caught.value.file == str(path)


@pytest.mark.parametrize("name", ["missing.nisp", "."])
def test_a_file_that_cannot_be_read_is_no_malformed_one(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    with pytest.raises(NispError, match="cannot be read") as caught:
        read(path)
    assert not isinstance(caught.value, FormatError)
    assert str(caught.value).startswith(f"{path}: ")


def test_a_path_with_nul_is_an_error_in_words() -> None:
    with pytest.raises(NispError, match="expected a path without NUL"):
        read("a\0b.nisp")
