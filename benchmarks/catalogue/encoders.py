"""Encoders in place of the real one: one that takes no time, and one that is short and wild."""

from __future__ import annotations

import math
import os
import time
from dataclasses import replace

import numpy as np

import nispcodec
from nispcodec import EncodeConfig, NispModel, TexturedMesh
from nispcodec.core.document import ChartTable, Document, Field, Frame
from nispcodec.core.network import Network, NetworkSpec
from nispcodec.core.progress import Listener
from nispcodec.dataset.config import SamplingConfig
from nispcodec.encode.config import Tuning
from nispcodec.train.config import LoopConfig, QuantizeConfig, TrainConfig, TrainingBudget

DIES, HANGS = "dies", "hangs"
"""Names of assets that do."""


def stub(mesh: TexturedMesh, config: EncodeConfig, listen: Listener) -> NispModel:
    """An octahedron in place of any mesh, at once."""
    axes = np.vstack([np.eye(3), -np.eye(3)]).astype(np.float32)
    third = np.full(1, -0.5, np.float32)
    tensors = {
        "weight.0": axes,
        "bias.0": np.zeros(6, np.float32),
        "weight.1": np.full((1, 6), 0.577, np.float32),
        "bias.1": third,
    }
    low = mesh.positions.min(axis=0)
    return NispModel(
        Document(
            frame=Frame((float(low[0]), float(low[1]), float(low[2])), 1.0),
            materials=mesh.materials[:1] if not mesh.textures else (nispcodec.Material(),),
            textures=(),
            field=Field(
                ChartTable(np.zeros(1, np.int32), np.zeros(1, np.bool_)),
                Network(NetworkSpec((6,), 1, activation="relu"), tensors),
            ),
        )
    )


def short(mesh: TexturedMesh, config: EncodeConfig, listen: Listener) -> NispModel:
    """The real encoder with few samples and steps; assets that die or hang do."""
    if mesh.name.startswith(DIES):
        os.abort()
    if mesh.name.startswith(HANGS):
        time.sleep(1e6)
    return nispcodec.encode(mesh, config, listen, _few())


def _few() -> Tuning:
    counts = {
        f"{name}_count": 300
        for name in ("near", "tight", "cube", "wide", "near_surface", "texture", "held_out", "thin")
    }
    usual = TrainConfig()
    training = replace(
        usual,
        budgets=dict.fromkeys(usual.budgets, TrainingBudget(30, 0.6, 1, 20)),
        probe_steps=5,
        quantize=QuantizeConfig(derivatives=2_000_000, least_samples=1000),
        loop=LoopConfig(useless=math.inf),
    )
    return Tuning(sampling=SamplingConfig(**counts), training=training)
