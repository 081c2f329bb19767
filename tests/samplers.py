"""Analyzed assets and samplers for tests, with as few tuned numbers changed as a test needs."""

from __future__ import annotations

import numpy as np

from nispcodec.core.asset import TexturedMesh
from nispcodec.dataset.config import SamplingConfig
from nispcodec.dataset.sampler import Sampler
from nispcodec.geometry.analysis import Analysis, analyze
from nispcodec.geometry.config import GeometryConfig, MergingConfig


def analysis_of(mesh: TexturedMesh, seed: int = 0, gap: float = 0.0) -> Analysis:
    """Charts further apart than the gap share a label; without a gap none do."""
    merging = MergingConfig(gap=gap) if gap else None
    return analyze(mesh, np.random.default_rng(seed), GeometryConfig(merging=merging))


def sampler_of(
    mesh: TexturedMesh, seed: int = 0, gap: float = 0.0, config: SamplingConfig | None = None
) -> Sampler:
    """A sampler of the analyzed mesh."""
    random = np.random.default_rng(seed)
    merging = MergingConfig(gap=gap) if gap else None
    analysis = analyze(mesh, random, GeometryConfig(merging=merging))
    return Sampler(analysis, random, config or SamplingConfig())
