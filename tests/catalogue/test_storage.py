from __future__ import annotations

import sys
from pathlib import Path

import pytest

from nispcodec.catalogue.storage import Local, full_disk, joined, storage_of
from nispcodec.core.errors import NispError


def test_local_files_are_written_with_their_folders(tmp_path: Path) -> None:
    place = joined(str(tmp_path), "a/b/c.nisp")
    storage_of(place).write(place, b"data")
    assert Local().read(place) == b"data"
    assert Local().folder(place).find("C.NISP") == tmp_path / "a" / "b" / "c.nisp"


@pytest.mark.parametrize("name", ["", "/a", "../a", "a/../b", "a//b", "./a", "a\0b"])
def test_names_that_leave_the_folder_are_refused(name: str) -> None:
    with pytest.raises(NispError, match="within the folder"):
        joined("out", name)


def test_a_url_needs_its_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "fsspec", None)
    monkeypatch.setattr("nispcodec.core.extras.find_spec", lambda name: None)
    with pytest.raises(NispError, match=r"pip install 'nispcodec\[remote\]'"):
        storage_of("s3://bucket/name")


def test_a_full_disk_is_told_through_other_errors() -> None:
    def wrapped() -> None:
        try:
            raise OSError(28, "No space left on device")
        except OSError as why:
            raise NispError("cannot be written") from why

    with pytest.raises(NispError) as caught:
        wrapped()
    assert full_disk(caught.value)
    assert not full_disk(OSError(13, "Permission denied"))
    assert not full_disk(None)
