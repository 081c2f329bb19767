from __future__ import annotations

from dataclasses import replace

import pytest

from nispcodec.catalogue.settings import Settings
from nispcodec.core.errors import NispError
from nispcodec.encode.config import EncodeConfig


def test_what_changes_bytes_changes_the_hash_and_threads_do_not() -> None:
    usual = Settings()
    assert replace(usual, encode=EncodeConfig(threads=7)).digest == usual.digest
    others = [usual.changed({"seed": 1}), usual.changed({"unwrap": True})]
    others.append(usual.changed({"prune": "smallest", "prune_rate": {"sdf": 0.5}}))
    assert len({usual.digest, *(each.digest for each in others)}) == 4


def test_texts_of_a_table_are_read_as_what_they_are_meant() -> None:
    texts = {"seed": "3", "target_size": "2000", "textures": "no", "unwrap": "true"}
    found = Settings().changed(texts)
    assert (found.encode.seed, found.encode.target_size) == (3, 2000.0)
    assert (found.encode.textures, found.unwrap) == (False, True)
    assert found.options == {"seed": 3, "target_size": 2000.0, "textures": False, "unwrap": True}


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"sed": 1}, "found 'sed'"),
        ({"threads": 1}, "found 'threads'"),
        ({"seed": "x"}, "seed: expected int"),
        ({"target_error": 1.0, "target_size": 5.0}, "expected one of them"),
    ],
)
def test_options_that_make_no_sense(options: dict[str, object], said: str) -> None:
    with pytest.raises(NispError, match=said):
        Settings().changed(options)
