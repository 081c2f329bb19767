"""The native backend's entrance: whether it can train a network, and the trainer that does."""

from __future__ import annotations

from nispcodec.train.backend.native.library import NativeError, available, library
from nispcodec.train.backend.native.nearest_grid import NearestGrid
from nispcodec.train.backend.native.settings import Settings
from nispcodec.train.backend.native.trainer import NativeTrainer, why_not

__all__ = [
    "NativeError",
    "NativeTrainer",
    "NearestGrid",
    "Settings",
    "available",
    "library",
    "why_not",
]
