from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.asset import TexturedMesh
from nispcodec.core.progress import silent
from nispcodec.encode.bodies import Sorted, sort_bodies
from nispcodec.encode.config import FormConfig
from nispcodec.encode.mesh_form import MeshForm
from nispcodec.geometry.analysis import analyze
from nispcodec.geometry.shown import shown
from tests.encode.mixed import BALL, BOX, CARD, HIDDEN, mixed


@pytest.fixture(scope="module")
def asset() -> TexturedMesh:
    return mixed()


@pytest.fixture(scope="module")
def found(asset: TexturedMesh) -> Sorted:
    analysis, config = analyze(asset), FormConfig()
    candidate = MeshForm(analysis, 0, config, silent).simplifier.balanced(250)
    return sort_bodies(shown(analysis), analysis.frame, candidate, config)


def test_a_dense_ball_suits_networks(asset: TexturedMesh, found: Sorted) -> None:
    assert found.dense.tolist() == (asset.face_materials == BALL).tolist()


def test_boxes_and_sheets_suit_triangles(asset: TexturedMesh, found: Sorted) -> None:
    seen = np.isin(asset.face_materials, [BOX, CARD])
    assert found.other.tolist() == seen.tolist()


def test_what_is_hidden_is_held_by_neither(asset: TexturedMesh, found: Sorted) -> None:
    hidden = asset.face_materials == HIDDEN
    assert hidden.any()
    assert not (found.dense | found.other)[hidden].any()


def test_the_bytes_are_those_of_the_candidate(found: Sorted) -> None:
    assert found.dense_size > found.other_size > 0
