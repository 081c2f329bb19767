"""How many bytes images take and what pictures lose by it: colors and data, each at one quality."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import takewhile

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.core.asset import Texture
from nispcodec.core.texture import named_apart
from nispcodec.encode.compact_images import LEAST, MOST, CompactImage
from nispcodec.encode.total_config import CompactConfig

QUALITIES = np.arange(LEAST, MOST + 1)
NOTHING = 1e-12
"""A squared error so small that its logarithm is still a number."""

Coding = tuple[int, str | None]
"""A quality, and what it is tuned to."""

ErrorOf = Callable[[tuple[Texture, ...]], float]


@dataclass(frozen=True)
class Curve:
    """Bytes (100,) and squared error of pictures (100,) of some images at every quality.

    They are known up to the quality `highest`; none beyond it is of use.
    """

    bytes: Float64Array
    errors: Float64Array
    highest: int


class ImageShares:
    """The images of an asset, and the best qualities of colors and of data for a sum of bytes.

    Images of a kind have one quality: the same step of rounding everywhere is the best that a sum
    of squares can have. `error_of` is told the textures and says what pictures of the original lose
    by them.
    """

    def __init__(
        self, images: Sequence[CompactImage], config: CompactConfig = CompactConfig()
    ) -> None:
        self._images, self._in_between = images, config.in_between
        self._kinds = [[image for image in images if image.is_data == kind] for kind in (0, 1)]
        self._curves: list[Curve] = []

    @property
    def least(self) -> int:
        """Bytes at the lowest quality, which are no more than those of the files as they came."""
        return sum(self._bytes(kind, LEAST) for kind in (0, 1))

    @property
    def smallest(self) -> tuple[Texture, ...]:
        """The images at the lowest quality."""
        return self._at((LEAST, None), (LEAST, None))

    @property
    def original(self) -> int:
        """Bytes of the files as they came."""
        return sum(len(image.original.data) for image in self._images)

    def measure(self, qualities: Sequence[int], most: float, error_of: ErrorOf) -> None:
        """Find out what each kind of images loses at some qualities, up to about `most` bytes."""
        self._curves = [self._curve(kind, qualities, most, error_of) for kind in (0, 1)]

    def error(self, most: float) -> float:
        """About the least squared error of pictures with images of so many bytes."""
        if most >= self.original:
            return NOTHING
        if most < self.least:
            return float("inf")
        first, second = (curve.errors[quality - 1] for curve, quality in self._best(most))
        return float(first + second)

    def fitted(self, most: float) -> tuple[Texture, ...]:
        """The images in `most` bytes at most, which are no fewer than `least`."""
        if most >= self.original:
            return tuple(image.original for image in self._images)
        (color_curve, _), (data_curve, expected) = self._best(most)
        data = self._largest(1, most - self._bytes(0, LEAST), expected)
        color = self._largest(0, most - self._bytes(1, data), color_curve.highest)
        data = self._largest(1, most - self._bytes(0, color), data_curve.highest)
        colors = self._filled(0, color, most - self._bytes(1, data))
        return self._at(colors, self._filled(1, data, most - self._bytes(0, *colors)))

    def _filled(self, kind: int, quality: int, most: float) -> Coding:
        """A quality, or how else a kind takes more of so many bytes."""
        lower = range(max(LEAST, quality - self._in_between), quality)
        ways: list[Coding] = [(quality, None), *((each, "psnr") for each in lower)]
        fit = [each for each in ways if self._bytes(kind, *each) <= most]
        return max(fit, key=lambda each: self._bytes(kind, *each), default=ways[0])

    def _at(self, color: Coding, data: Coding) -> tuple[Texture, ...]:
        return named_apart([each.at(*(data if each.is_data else color)) for each in self._images])

    def _bytes(self, kind: int, quality: int, tune: str | None = None) -> int:
        return sum(len(image.at(quality, tune).data) for image in self._kinds[kind])

    def _curve(self, kind: int, qualities: Sequence[int], most: float, error_of: ErrorOf) -> Curve:
        if not self._kinds[kind]:
            return Curve(np.zeros(len(QUALITIES)), np.zeros(len(QUALITIES)), LEAST)
        fit = len(list(takewhile(lambda each: self._bytes(kind, each) <= most, qualities)))
        # One that does not fit tells what lies below it.
        tried = qualities[: fit + 1]
        errors = [error_of(self._only(kind, quality)) for quality in tried]
        sizes = [self._bytes(kind, quality) for quality in tried]
        return Curve(_powers(tried, sizes), _powers(tried, errors), tried[-1])

    def _only(self, kind: int, quality: int) -> tuple[Texture, ...]:
        """The images of one kind at a quality, the others as they came."""
        chosen = [
            each.at(quality) if each.is_data == kind else each.original for each in self._images
        ]
        return tuple(chosen)

    def _best(self, most: float) -> list[tuple[Curve, int]]:
        """The curves of both kinds, and the qualities that are expected to be best."""
        color, data = self._curves
        sizes = color.bytes[:, None] + data.bytes
        errors = np.where(sizes <= most, color.errors[:, None] + data.errors, np.inf)
        found = np.unravel_index(int(errors.argmin()), errors.shape)
        return [
            (curve, LEAST + int(which)) for curve, which in zip(self._curves, found, strict=True)
        ]

    def _largest(self, kind: int, most: float, highest: int) -> int:
        """The highest quality, up to `highest`, at which a kind takes `most` bytes at most."""
        if not self._kinds[kind] or self._bytes(kind, highest) <= most:
            return highest
        low, high = LEAST, highest
        while high - low > 1:
            few, many = (np.log(self._bytes(kind, each)) for each in (low, high))
            share = (np.log(max(most, 1)) - few) / max(many - few, NOTHING)
            middle = int(np.clip(round(low + share * (high - low)), low + 1, high - 1))
            if self._bytes(kind, middle) <= most:
                low = middle
            else:
                high = middle
        return low


def _powers(at: Sequence[int], values: Sequence[float]) -> Float64Array:
    """Values at every quality, powers of it between those that are known."""
    logarithms = np.log(np.maximum(np.asarray(values, np.float64), NOTHING))
    return np.exp(np.interp(QUALITIES, at, logarithms))
