"""Channels that a picture can show besides light: a function for each, from samples to colors."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from nispcodec.core.arrays import Float32Array
from nispcodec.core.errors import QueryError
from nispcodec.render.picture import Eye, Samples

MANY_STEPS = 64
# Neighboring numbers get hues far apart.
GOLDEN = 0.618034


def channel_picture(eye: Eye, channel: str) -> Float32Array:
    """A channel of `CHANNELS` as a picture (size, size, 4) float32 RGBA in [0, 1], top row first.

    "color" is what the eye sees. The others have one sample a pixel, as they are no light to mix.
    Raises QueryError for another channel.
    """
    if channel == "color":
        return eye.picture()
    if channel not in _COLORS:
        known = ", ".join(CHANNELS)
        raise QueryError(f"channel: expected one of {known}, found {channel!r}")
    seen = eye.pixels()
    shown = np.ones(len(seen.steps)) if channel == "sdf-steps" else np.isfinite(seen.distances)
    colors = np.column_stack([_COLORS[channel](eye, seen), shown]) * shown[:, None]
    return colors.astype(np.float32).reshape(eye.size, eye.size, 4)


def _normal(eye: Eye, seen: Samples) -> Float32Array:
    """World axes: red to +x, green to +y, blue to +z; a half is 0."""
    return np.float32(0.5) * (seen.normals + 1)


def _uv(eye: Eye, seen: Samples) -> Float32Array:
    """Red is u, green is v; tiles look alike."""
    return np.column_stack([seen.uvs % 1, np.zeros(len(seen.uvs), np.float32)])


def _chart(eye: Eye, seen: Samples) -> Float32Array:
    phase = seen.charts[:, None] * GOLDEN + np.arange(3) / 3
    colors: Float32Array = (0.55 + 0.4 * np.cos(2 * np.pi * phase)).astype(np.float32)
    return colors


def _depth(eye: Eye, seen: Samples) -> Float32Array:
    """White where the unit ball begins, black where it ends."""
    nearest = np.linalg.norm(eye.camera.eye) - 1
    gray = 1 - np.clip(np.nan_to_num(seen.distances - nearest, posinf=0) / 2, 0, 1)
    return np.repeat(gray[:, None], 3, axis=1).astype(np.float32)


def _steps(eye: Eye, seen: Samples) -> Float32Array:
    """Black through red and yellow to white: how often the network was asked, up to MANY_STEPS."""
    share = seen.steps[:, None] / MANY_STEPS
    heat: Float32Array = np.clip(3 * share - np.arange(3), 0, 1).astype(np.float32)
    return heat


_COLORS: dict[str, Callable[[Eye, Samples], Float32Array]] = {
    "normal": _normal,
    "uv": _uv,
    "chart": _chart,
    "depth": _depth,
    "sdf-steps": _steps,
}
CHANNELS = ("color", *_COLORS)
