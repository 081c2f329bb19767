"""Candidates for a part: so many faces, so many bits; and the smallest within an error."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from nispcodec.core.arrays import BoolArray
from nispcodec.core.mesh_part import MAX_GRID_BITS, MeshPart
from nispcodec.simplify.collapse import collapsed
from nispcodec.simplify.config import LadderConfig
from nispcodec.simplify.errors import Errors, Original, mesh_of
from nispcodec.simplify.position_fit import fitted_positions
from nispcodec.simplify.quantize import Grid, quantized
from nispcodec.simplify.source import Source
from nispcodec.simplify.triangles import Triangles
from nispcodec.simplify.uv_fit import fitted_uvs

Coded = Callable[[MeshPart], int]
"""The bytes of a part."""


@dataclass(frozen=True)
class Candidate:
    """A part, what it costs and how far it is from the original."""

    part: MeshPart
    bits: int
    uv_bits: int
    errors: Errors
    size: int

    @property
    def faces(self) -> int:
        """How many triangles."""
        return len(self.part.faces)


@dataclass(frozen=True)
class Simplifier:
    """Makes candidates of one source; what was fitted once is kept.

    coded     the bytes of a part
    original  what errors are measured against
    """

    source: Source
    original: Original
    coded: Coded
    config: LadderConfig = LadderConfig()
    seed: int = 0
    _fitted: dict[int, Triangles] = field(default_factory=dict)

    @staticmethod
    def of(
        triangles: Triangles,
        coded: Coded,
        config: LadderConfig = LadderConfig(),
        seed: int = 0,
        counted: BoolArray | None = None,
    ) -> Simplifier:
        """counted: (m,) bool, the faces whose points count as the original; None: all.

        Raises MeshError where no face has an area.
        """
        source = Source(triangles)
        original = Original.of(triangles, source.tree, config.samples, seed, counted)
        return Simplifier(source, original, coded, config, seed)

    def fitted(self, faces: int) -> Triangles:
        """About so many triangles, positions fitted; the source itself for as many as it has."""
        if faces not in self._fitted:
            triangles = self.source.triangles
            if faces < len(triangles):
                fewer = collapsed(triangles, faces, self.config.collapse)
                triangles = fitted_positions(self.source, fewer, self.config.fit, self.seed)
            self._fitted[faces] = triangles
        return self._fitted[faces]

    def candidate(self, faces: int, bits: int, uv_bits: int) -> Candidate:
        """About so many triangles, rounded, coded and measured."""
        triangles = self.fitted(faces)
        if faces < len(self.source.triangles):
            # UVs are fitted to the places that rounding leaves.
            places = Grid.of(triangles.positions, bits).rounded(triangles.positions)
            placed = replace(triangles, positions=places)
            uvs = fitted_uvs(self.source, placed, self.config.fit, self.seed).uvs
            triangles = replace(triangles, uvs=uvs)
        part = quantized(triangles, bits, uv_bits, self.config.crease_angle)
        errors = self.original.errors(mesh_of(part))
        return Candidate(part, bits, uv_bits, errors, self.coded(part))

    def balanced(self, faces: int) -> Candidate:
        """About so many faces, with bits whose rounding suits the error that is there before."""
        before = self.original.errors(self.fitted(faces).mesh())
        bits = self.bits_for(max(before.distance, self.config.tolerance))
        uv_bits = self.uv_bits_for(max(before.uv_median, self.config.uv_tolerance))
        return self.candidate(faces, bits, uv_bits)

    def bits_for(self, distance: float) -> int:
        """Bits a coordinate whose rounding is the best part of a mean distance."""
        positions = self.source.triangles.positions
        extent = float(np.ptp(positions, axis=0).max())
        return _bits(extent, self.config.step * distance)

    def uv_bits_for(self, uv: float) -> int:
        """Bits a texture coordinate whose rounding is the best part of a typical UV error."""
        uvs = self.source.triangles.uvs
        extent = float(np.ptp(uvs, axis=0).max()) if len(uvs) else 0.0
        return _bits(extent, self.config.uv_step * uv)


def ladder(simplifier: Simplifier) -> list[Candidate]:
    """Candidates from few faces to all, fewest first; the bits of each by the error it has."""
    everything = len(simplifier.source.triangles)
    config = simplifier.config
    count = max(2, round(config.rungs * np.log2(max(everything / config.fewest, 2)) / 8))
    wanted = np.geomspace(min(config.fewest, everything), everything, count)
    return [simplifier.balanced(round(float(faces))) for faces in wanted]


def best_for(simplifier: Simplifier, distance: float, uv: float) -> Candidate | None:
    """The fewest bytes found whose mean distance and mean UV error are at most so large.

    None where not even all faces with the most bits are.
    """
    bits, uv_bits = simplifier.bits_for(distance), simplifier.uv_bits_for(uv)
    tried = list(_approach(simplifier, bits, uv_bits, distance, uv))
    good = [each for each in tried if each.errors.within(distance, uv)]
    if not good:
        return kept_whole(simplifier, distance, uv)
    return min(good, key=lambda each: each.size)


def kept_whole(simplifier: Simplifier, distance: float, uv: float) -> Candidate | None:
    """All faces of the source with the fewest bits whose rounding stays within the errors.

    None where not even the most bits do.
    """
    everything = len(simplifier.source.triangles)
    bits, uv_bits = simplifier.bits_for(distance), simplifier.uv_bits_for(uv)
    found = simplifier.candidate(everything, bits, uv_bits)
    while not found.errors.within(distance, uv):
        if max(bits, uv_bits) == MAX_GRID_BITS:
            return None
        far = found.errors.distance > distance
        wrong = found.errors.uv > uv
        # Where faces lie on each other, rounding puts another one in front: with UVs of its own.
        finer = found if far else simplifier.candidate(everything, bits, uv_bits + 1)
        helps = finer.errors.uv < simplifier.config.helping * found.errors.uv
        bits, uv_bits = bits + (far or not helps), uv_bits + (wrong and helps)
        found = finer if helps and not far else simplifier.candidate(everything, bits, uv_bits)
    return found


def _approach(
    simplifier: Simplifier, bits: int, uv_bits: int, distance: float, uv: float
) -> Iterator[Candidate]:
    """Candidates that close in on the fewest faces within the errors, then some with other bits."""
    config = simplifier.config
    everything = len(simplifier.source.triangles)
    few, many = 1.0, float(everything)
    faces = np.sqrt(config.fewest * everything) if everything > config.fewest else everything
    best: tuple[int, Candidate] | None = None
    slope = -1.0
    last: tuple[float, float] | None = None
    for _ in range(config.trials):
        asked = round(float(faces))
        found = simplifier.candidate(asked, bits, uv_bits)
        yield found
        excess = float(np.log(_excess(found.errors, distance, uv)))
        if excess <= 0:
            many, best = min(many, faces), (asked, found)
        else:
            few = max(few, faces)
        if -config.close <= excess <= 0 or many / few < 1 + config.close:
            break
        here = (float(np.log(faces)), excess)
        if last is not None and abs(here[0] - last[0]) > config.close:
            slope = float(np.clip((here[1] - last[1]) / (here[0] - last[0]), -3.0, -0.4))
        last = here
        # A little below the limit, so that what comes is within it.
        faces = np.exp(here[0] - (excess + config.close / 2) / slope)
        if not few < faces < many:
            faces = np.sqrt(few * many)
    if best is not None:
        yield from _other_bits(simplifier, *best, distance, uv)


def _other_bits(
    simplifier: Simplifier, faces: int, found: Candidate, distance: float, uv: float
) -> Iterator[Candidate]:
    """Fewer bits for the same faces, as long as they stay within the errors."""
    for change in ((1, 0), (0, 1)):
        bits, uv_bits = found.bits, found.uv_bits
        while min(bits - change[0], uv_bits - change[1]) >= 1:
            bits, uv_bits = bits - change[0], uv_bits - change[1]
            fewer = simplifier.candidate(faces, bits, uv_bits)
            if not fewer.errors.within(distance, uv):
                break
            found = fewer
            yield fewer


def _excess(errors: Errors, distance: float, uv: float) -> float:
    """By what factor the worse of both is too large."""
    tiny = np.finfo(np.float64).tiny
    return max(errors.distance / distance, errors.uv / uv, tiny)


def _bits(extent: float, step: float) -> int:
    """The fewest bits whose grid over an extent has at most this step."""
    if extent <= step:
        return 1
    return int(np.clip(np.ceil(np.log2(extent / step + 1)), 1, MAX_GRID_BITS))
