"""Analyzed assets and samplers for tests, with as few tuned numbers changed as a test needs."""

from __future__ import annotations

from nispcodec.core.asset import TexturedMesh
from nispcodec.dataset.config import SamplingConfig
from nispcodec.dataset.sampler import Sampler
from nispcodec.geometry.analysis import Analysis, analyze
from nispcodec.geometry.config import GeometryConfig, MergingConfig


def analysis_of(mesh: TexturedMesh, seed: int = 0, gap: float = 0.0) -> Analysis:
    """Charts further apart than the gap share a label; without a gap none do."""
    merging = MergingConfig(gap=gap) if gap else None
    return analyze(mesh, seed, GeometryConfig(merging=merging))


def sampler_of(
    mesh: TexturedMesh, seed: int = 0, gap: float = 0.0, config: SamplingConfig | None = None
) -> Sampler:
    """A sampler of the analyzed mesh."""
    return Sampler(analysis_of(mesh, seed, gap), seed, config or SamplingConfig())
