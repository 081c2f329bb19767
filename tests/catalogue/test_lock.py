from __future__ import annotations

from pathlib import Path

import pytest

from nispcodec.catalogue.lock import locked
from nispcodec.catalogue.plan import Shard
from nispcodec.core.errors import NispError


def test_a_second_driver_is_refused_until_the_first_is_done(tmp_path: Path) -> None:
    with (
        locked(tmp_path),
        pytest.raises(NispError, match=r"found process \d+ on"),
        locked(tmp_path),
    ):
        pass
    with locked(tmp_path):
        pass


def test_shards_work_side_by_side_and_each_once(tmp_path: Path) -> None:
    with locked(tmp_path, Shard(1, 2)), locked(tmp_path, Shard(2, 2)):
        for other in (Shard(1, 2), None):
            with pytest.raises(NispError, match="expected no other"), locked(tmp_path, other):
                pass
