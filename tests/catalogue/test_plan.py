from __future__ import annotations

import pytest

from nispcodec.catalogue.plan import Asset, Problem, Shard, told_apart
from nispcodec.core.errors import NispError


def test_two_files_of_one_output_are_told_and_one_file_twice_is_none() -> None:
    first, same, other = (Asset(name, "a.nisp") for name in ("x/a.obj", "x/a.obj", "y/a.obj"))
    lost = Problem("z", "gone")
    assets, problems = told_apart([first, lost, same, other, Asset("b", "Z.nisp")])
    assert [each.output for each in assets] == ["Z.nisp", "a.nisp"]
    assert problems[0] == lost
    assert problems[1].source == "y/a.obj"
    assert "x/a.obj has it too (a.nisp)" in problems[1].error


def test_shards_split_everything_once_and_the_same_way() -> None:
    names = [f"asset-{number}.nisp" for number in range(300)]
    parts = [[name for name in names if Shard(part, 3).has(name)] for part in (1, 2, 3)]
    assert sorted(name for part in parts for name in part) == sorted(names)
    assert min(map(len, parts)) > 60
    assert Shard(2, 3).has("\udce9.nisp") in (True, False)


@pytest.mark.parametrize("shard", [(0, 3), (4, 3), (1, 0)])
def test_a_shard_is_within_its_count(shard: tuple[int, int]) -> None:
    with pytest.raises(NispError, match="expected 1/N to N/N"):
        Shard(*shard)
