"""How to encode: what a user chooses, and the tuned numbers behind it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from nispcodec.core.errors import NispError
from nispcodec.dataset.config import SamplingConfig
from nispcodec.geometry.config import GeometryConfig
from nispcodec.train.config import TrainConfig

if TYPE_CHECKING:
    from nispcodec.train.prune import Pruning

PRESETS = ("balanced", "paper", "fast", "best")


@dataclass(frozen=True)
class EncodeConfig:
    """How to encode.

    preset          one of `PRESETS`
    seed            of everything random: the same input, seed and threads give the same bytes
    device          "auto", "cpu", "cuda"
    threads         cores to use; 0: all
    pad_textures    fills what no face uses of an image with the colors beside it
    texture_format  None keeps the image files as they are; "webp", "avif", "jpeg" re-encode them
    texture_quality 1 to 100, for a `texture_format` and for images that are padded
    textures        False leaves the images out
    target_size     bytes of the file without its textures; the networks are made to fit
    target_error    mean distance to the surface (normalized frame); the SDF is made to fit
    prune           None, "smallest", "smallest_global" or "large_final": lottery tickets
    prune_rate      share of weights to prune, 0 to below 1; or by network: {"sdf": 0.3, "uv": 0.5}
    prune_rounds    in which the rate is reached: each takes as long as an encode
    """

    preset: str = "balanced"
    seed: int = 0
    device: str = "auto"
    threads: int = 0
    pad_textures: bool = False
    texture_format: str | None = None
    texture_quality: int = 90
    textures: bool = True
    target_size: float | None = None
    target_error: float | None = None
    prune: str | None = None
    prune_rate: float | Mapping[str, float] = 0.5
    prune_rounds: int = 2

    def __post_init__(self) -> None:
        if self.preset not in PRESETS:
            raise NispError(f"preset: expected one of {', '.join(PRESETS)}, found {self.preset!r}")
        if self.seed < 0 or self.threads < 0:
            raise NispError("seed and threads: expected 0 or more")
        targets = [each for each in (self.target_size, self.target_error) if each is not None]
        if len(targets) > 1 or (targets and self.preset == "paper"):
            raise NispError("target size, target error, preset paper: expected one of them")
        if any(not 0 < each < math.inf for each in targets):
            raise NispError(f"target size or error: expected more than 0, found {targets[0]:g}")
        self.prunings()

    def prunings(self) -> dict[str, Pruning]:
        """The pruning of every network that is to be pruned, by its name."""
        from nispcodec.train.prune import prunings

        return prunings(self.prune, self.prune_rate, self.prune_rounds) if self.prune else {}


@dataclass(frozen=True)
class Tuning:
    """Every tuned number of an encode. Tests make them small; users have `EncodeConfig`.

    negligible     share of the radius, and of the UV scale, that nobody sees: a thousandth of what
                   evaluators may differ by; what loses no more is stored in single precision
    notable_open   from this share of the area on, open surfaces are worth the finer extraction that
                   they need
    """

    geometry: GeometryConfig = field(default_factory=GeometryConfig)
    sampling: SamplingConfig = field(default_factory=SamplingConfig)
    training: TrainConfig = field(default_factory=TrainConfig)
    negligible: float = 1e-7
    notable_open: float = 0.02

    def geometry_of(self, preset: str) -> GeometryConfig:
        """The preset `paper` knows neither cut nor merged charts."""
        return replace(self.geometry, merging=None) if preset == "paper" else self.geometry
