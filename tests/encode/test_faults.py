"""Thin things that a short fit turns into something else: that is said, and triangles are taken."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import nispcodec
from nispcodec import EncodeConfig, NispModel, TexturedMesh
from nispcodec.core.asset import Material
from nispcodec.core.progress import Progress
from nispcodec.encode.faults import fault_warnings
from nispcodec.metrics.faulty_points import FaultyPoints
from nispcodec.simplify.errors import Errors
from nispcodec.train.config import TrainConfig
from tests import tiny
from tests.encode.thin_things import cage, cards
from tests.encode.tunings import small

TUNING = small(2000, 100, 1, 60, 30, lambda_=1e-6)
HELD = replace(
    tiny.document(),
    materials=(Material("cage"), Material("foot")),
    frame=replace(tiny.document().frame, center=(0.0, 100.0, 0.0), radius=10.0),
)


def far(count: int, at: tuple[float, float, float] = (0.5, 0.0, 0.0)) -> FaultyPoints:
    """So many of 1,000 points, along a line of 0.2 about a place."""
    along = np.linspace(-0.1, 0.1, count)[:, None] * [0.0, 0.0, 1.0]
    return FaultyPoints(1000, np.asarray(at) + along, np.ones(count, np.int32))


def warnings(
    better: str | None = "balanced", discolored: FaultyPoints | None = None, **points: Any
) -> list[str]:
    errors, none = Errors(0.0, 0.0, 0.0, 0.0, **points), FaultyPoints()
    return list(fault_warnings(HELD, errors, discolored or none, better, 5e-4))


def test_a_warning_names_share_place_size_material_and_what_to_do() -> None:
    (told,) = warnings(made_up=far(25))
    assert told.startswith("2.5 % of the decoded surface is made up")
    assert "within 0.1 of it" in told
    assert "about (5, 100, 0), 0 x 0 x 2 large, of material 'foot'" in told
    assert "--geometry mesh or --preset balanced" in told
    (lost,) = warnings(None, lost=far(1000))
    assert "100 % of the original's surface is lost" in lost
    assert "--preset" not in lost
    (told,) = warnings(discolored=far(2))
    assert told.startswith("0.2 % of the original's surface comes out in another color; most about")


def test_little_of_it_is_no_warning() -> None:
    assert warnings(made_up=FaultyPoints(2001, np.zeros((1, 3)), np.zeros(1, np.int32))) == []


def test_a_better_preset_is_the_next_one() -> None:
    training = TrainConfig()
    assert [training.better_than(each) for each in ("fast", "balanced", "best", "paper")] == [
        "balanced",
        "best",
        None,
        None,
    ]


def encoded(mesh: TexturedMesh, geometry: str) -> tuple[NispModel, list[str]]:
    told: list[Progress] = []
    config = EncodeConfig("fast", geometry=geometry, seed=1)
    model = nispcodec.encode(mesh, config, told.append, TUNING)
    return model, [each.warning for each in told if "surface is" in each.warning]


@pytest.mark.slow
@pytest.mark.parametrize("mesh", [cage(), cards()], ids=["cage", "cards"])
def test_webs_and_beans_are_told_and_triangles_have_none(mesh: TexturedMesh) -> None:
    field, told = encoded(mesh, "field")
    info = field.document.info
    assert float(info["made_up_share"]) + float(info["lost_share"]) > 0.01
    assert told
    chosen, told = encoded(mesh, "auto")
    assert chosen.document.field is None
    assert (told, chosen.document.info["made_up_share"]) == ([], 0)
