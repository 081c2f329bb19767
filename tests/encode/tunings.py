"""Small numbers for encodes that take a second."""

from __future__ import annotations

import math
from dataclasses import replace

from nispcodec.dataset.config import SamplingConfig
from nispcodec.encode.config import FormConfig, Tuning
from nispcodec.train.config import (
    LoopConfig,
    PaperConfig,
    QuantizeConfig,
    TrainConfig,
    TrainingBudget,
)

COUNTS = ("near", "tight", "cube", "wide", "near_surface", "texture", "held_out", "paper", "thin")


def small(
    samples: int,
    steps: int,
    minings: int,
    mine_every: int,
    probe_steps: int,
    lambda_: float = 0,
) -> Tuning:
    """Few samples of each kind, so many steps for every preset; lambda of all networks.

    Errors are measured on a coarse surface of the networks: a fine one takes longer than such fits.
    """
    default = TrainConfig()
    budget = TrainingBudget(steps, 0.6, minings, mine_every)
    networks = {
        name: replace(each, lambda_=lambda_ or each.lambda_)
        for name, each in default.networks.items()
    }
    training = TrainConfig(
        budgets=dict.fromkeys(default.budgets, budget),
        networks=networks,
        probe_steps=probe_steps,
        quantize=QuantizeConfig(derivatives=2_000_000, least_samples=1000),
        # So short a fit is useless, and that is no error here.
        loop=LoopConfig(useless=math.inf),
        paper=PaperConfig(steps=60),
    )
    counts = {f"{name}_count": samples for name in COUNTS}
    forms = FormConfig(measured_faces=20_000)
    return Tuning(sampling=SamplingConfig(**counts), training=training, forms=forms)
