"""An asset in two, and the whole way to a file that holds both forms."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import nispcodec
from nispcodec import EncodeConfig
from nispcodec.core.arrays import BoolArray
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.progress import silent
from nispcodec.encode.bodies import Sorted
from nispcodec.encode.config import EncodeConfig as Config
from nispcodec.encode.config import Tuning
from nispcodec.encode.field_form import FieldForm
from nispcodec.encode.split import split
from nispcodec.format import pack, unpack
from nispcodec.geometry.analysis import analyze
from nispcodec.model import NispModel
from nispcodec.train.backend.choice import choose_engine
from tests.encode.mixed import BALL, BOX, CARD, mixed
from tests.encode.tunings import small
from tests.geometry.shapes import cube, hemisphere, soup

SHORT = small(3000, 60, 1, 100, 30, lambda_=1e-6)


def whole(mesh: TexturedMesh) -> FieldForm:
    engine = choose_engine("auto", "cpu", False, silent)
    return FieldForm(analyze(mesh), Config(), Tuning(), engine, silent)


def sorted_by(dense: BoolArray) -> Sorted:
    return Sorted(dense, ~dense, 5000.0, 500.0, 1e-3, sheets=False)


def test_halves_have_the_frame_of_the_whole_and_all_of_their_bodies() -> None:
    mesh = mixed(8)
    field = whole(mesh)
    found = split(field, sorted_by(mesh.face_materials == BALL))
    assert found is not None
    dense = found.field.analysis
    assert dense.frame == field.analysis.frame
    # Neither half hides faces of the other: the foot of the ball, which stands in the box.
    assert field.analysis.solid.hidden_share > dense.solid.hidden_share == 0


def test_bodies_that_others_close_are_not_torn_from_them() -> None:
    bowl = hemisphere(8)
    mesh = soup(np.concatenate([bowl, cube((-1.5, -1.5, -3.0), 3.0)]))
    assert split(whole(mesh), sorted_by(np.arange(len(mesh.faces)) < len(bowl))) is None


def test_bodies_that_are_seen_through_an_opening_alone_have_a_share_of_the_area() -> None:
    """A small box in one without a lid: as a whole it is inside, and has no outer surface."""
    box = cube((-1.0, -1.0, -1.0), 2.0)
    cup = box[~(box[..., 2] == 1).all(axis=1)]
    mesh = soup(np.concatenate([cup, cube((-0.25, -0.25, -0.9), 0.5)]))
    found = split(whole(mesh), sorted_by(np.arange(len(mesh.faces)) < len(cup)))
    assert found is not None
    assert found.share == pytest.approx(1.5 / (20 + 1.5), rel=0.1)


@pytest.mark.slow
def test_both_forms_are_one_file() -> None:
    mesh = mixed()
    # So short a fit foresees nothing, and triangles alone are not looked at.
    forms = replace(SHORT.forms, least_networks=1.0, worth_mixing=1e9, most_worth=0.0)
    tuning = replace(SHORT, forms=replace(forms, surely_larger=1e-9, surely_best=-math.inf))
    model = nispcodec.encode(mesh, EncodeConfig(), tuning=tuning)
    again = nispcodec.encode(mesh, EncodeConfig(), tuning=tuning)
    data = pack(model.document)
    assert data == pack(again.document)
    document = unpack(data)
    assert document.field is not None
    assert set(document.field.charts.materials.tolist()) == {BALL}
    held = {int(each) for part in document.meshes for each in part.chart_materials}
    assert held == {BOX, CARD}
    assert document.frame.radius == pytest.approx(analyze(mesh).frame.radius)
    loaded = NispModel(document)
    assert loaded.sdf([[0.9, 0.9, -2.6]])[0] < 0
    assert set(loaded.to_mesh(32).face_materials.tolist()) == {BALL, BOX, CARD}
