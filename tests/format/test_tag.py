"""Tags: one byte where it is enough, four otherwise, and nothing that is not known."""

from __future__ import annotations

import pytest

from nispcodec.core.errors import FormatError
from nispcodec.format import tag
from nispcodec.format.codings.reader import Reader
from nispcodec.format.codings.registry import REGISTRY
from nispcodec.format.constants import STEPS
from nispcodec.format.tag import MOST_TOGETHER, Tag


@pytest.mark.parametrize("coding", range(1, 1 + len(REGISTRY)))
@pytest.mark.parametrize("joined", [0, MOST_TOGETHER - 1, MOST_TOGETHER, 68])
def test_what_is_written_is_read(coding: int, joined: int) -> None:
    for form in range(1 + len(STEPS)):
        written = Tag(coding, form, joined)
        reader = Reader("NETS", written.encode())
        assert tag.decode(reader) == written
        reader.finish()
        assert len(written.encode()) == (1 if joined < MOST_TOGETHER else 4)


@pytest.mark.parametrize("unknown", [Tag(8, 0, 0), Tag(255, 255, 255), Tag(1, 8, 0)])
def test_there_is_room_for_what_a_later_version_brings(unknown: Tag) -> None:
    data = unknown.encode()
    assert data == bytes([0, unknown.coding, unknown.form, unknown.joined])
    with pytest.raises(FormatError, match="of this version, found"):
        tag.decode(Reader("NETS", data))


@pytest.mark.parametrize("data", [b"\x08", b"\0\0\0\x04", b"\0\1\0\0", b"\0\6\7\3", b"\0\1"])
def test_a_tag_has_one_form(data: bytes) -> None:
    with pytest.raises(FormatError, match="field coding"):
        tag.decode(Reader("NETS", data))
