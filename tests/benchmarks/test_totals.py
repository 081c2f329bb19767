"""The fewest bytes of a rival whose pictures are as good as ours."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from benchmarks.headline.totals import Coded, Geometry, Rivals


class Scene:
    """Loses so much; with some images, what they lose besides."""

    def __init__(self, error: float) -> None:
        self.error = error

    def with_textures(self, textures: Any) -> Scene:
        return Scene(self.error + textures[0])


def geometry(size: int, error: float) -> Geometry:
    scene: Any = Scene(error)
    return Geometry("draco", {"qp": size}, size, scene, error)


def images(size: int, error: float, really: float | None = None, taken: int | None = None) -> Coded:
    lost: Any = (error if really is None else really,)
    return Coded(f"avif {size}", size, error, lambda: (taken or size, lost))


def fewest(geometries: list[Geometry], coded: list[Coded], wanted: float = 10.0) -> Any:
    pictures: Any = SimpleNamespace(error=lambda scene: scene.error)
    asset: Any = None
    return Rivals(asset, pictures, wanted, total=900).fewest(geometries, coded)


def test_the_smallest_pair_that_is_good_enough_is_found() -> None:
    found = fewest([geometry(100, 8), geometry(300, 1)], [images(400, 8), images(1000, 1)])
    assert (found["geometry"], found["bytes"], found["images"]) == (300, 700, "avif 400")
    assert found["share"] == pytest.approx(900 / 700)


def test_what_was_only_expected_to_be_good_enough_does_not_count() -> None:
    found = fewest([geometry(100, 1)], [images(400, 8, really=12), images(1000, 2)])
    assert found["bytes"] == 1100


def test_a_rival_that_is_never_as_good_has_no_bytes() -> None:
    assert fewest([geometry(100, 1)], [images(400, 20)]) == {"bytes": None}


def test_bytes_are_those_that_images_take() -> None:
    found = fewest([geometry(100, 1)], [images(400, 8), images(410, 5, taken=380)])
    assert found["bytes"] == 480
