"""Networks that are tried before they are fitted, in whole encodes of a second."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

import nispcodec
from nispcodec import EncodeConfig
from nispcodec.core.progress import Progress
from nispcodec.encode.config import Tuning
from nispcodec.encode.targets import TRIAL
from nispcodec.format import pack
from nispcodec.model import NispModel
from tests.encode.tunings import small
from tests.geometry.shapes import soup, sphere


def in_doubt(gain: float) -> Tuning:
    """A tuning by which triangles and networks are always close; a fit gains so much on a trial."""
    tuning = small(2000, 40, 1, 100, 20)
    budget = replace(tuning.training.budgets["balanced"], trial=10)
    training = replace(tuning.training, budgets={"balanced": budget})
    forms = replace(
        tuning.forms,
        surely_best=-math.inf,
        surely_smaller=0.0,
        surely_smaller_fine=0.0,
        surely_larger=math.inf,
        least_networks=math.inf,
        trial_gain=gain,
    )
    return replace(tuning, training=training, forms=forms)


def encoded(gain: float) -> tuple[NispModel, list[Progress]]:
    seen: list[Progress] = []
    return nispcodec.encode(soup(sphere(8)), EncodeConfig(), seen.append, in_doubt(gain)), seen


@pytest.mark.parametrize(("gain", "fitted"), [(-math.inf, False), (math.inf, True)])
def test_networks_are_fitted_only_if_a_trial_leaves_them_hope(gain: float, fitted: bool) -> None:
    model, seen = encoded(gain)
    stages = [each.stage for each in seen]
    assert TRIAL in stages
    assert any(each.network for each in seen) is fitted
    if not fitted:
        assert model.document.field is None
        assert "other_form_bytes" in model.document.info
    shares = [each.overall for each in seen]
    assert shares == sorted(shares)
    assert shares[-1] == 1


def test_a_trial_is_the_same_every_time() -> None:
    assert pack(encoded(-math.inf)[0].document) == pack(encoded(-math.inf)[0].document)
