"""Candidates for a part: so many faces, so many bits, with what they cost and their errors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from nispcodec.core.mesh_part import MAX_GRID_BITS, MeshPart
from nispcodec.metrics.paint import Paint
from nispcodec.simplify.closest import Tree
from nispcodec.simplify.collapse import collapsed
from nispcodec.simplify.config import LadderConfig
from nispcodec.simplify.copies import Copies
from nispcodec.simplify.copy_search import copies_of
from nispcodec.simplify.discolored import Discolored
from nispcodec.simplify.errors import Counted, Errors, Original, mesh_of
from nispcodec.simplify.halves import with_halves
from nispcodec.simplify.mirror import Mirror
from nispcodec.simplify.position_fit import fitted_positions
from nispcodec.simplify.quantize import Grid
from nispcodec.simplify.scene import scene
from nispcodec.simplify.shading import bent_creases, shaded
from nispcodec.simplify.source import Source
from nispcodec.simplify.triangles import Triangles
from nispcodec.simplify.uv_fit import fitted_uvs

Coded = Callable[[tuple[MeshPart, ...]], int]
"""The bytes of parts, together."""


@dataclass(frozen=True)
class Candidate:
    """Parts, what they cost and how far they are from the original.

    asked  about how many faces were to be left of the source's
    """

    asked: int
    parts: tuple[MeshPart, ...]
    bits: int
    uv_bits: int
    errors: Errors
    coded: Coded

    @cached_property
    def size(self) -> int:
        """Bytes, counted when they are asked for: coding takes as long as all else."""
        return self.coded(self.parts)

    @property
    def faces(self) -> int:
        """How many triangles, those of copies not counted."""
        return sum(len(part.faces) for part in self.parts)


@dataclass(frozen=True)
class Simplifier:
    """Makes candidates of one source; what was made once is kept.

    source    without copies
    coded     the bytes of parts
    original  what errors are measured against
    told      called after each candidate
    planes    in which halves may be reflected, where all faces are kept
    """

    copies: Copies
    source: Source
    original: Original
    coded: Coded
    config: LadderConfig = LadderConfig()
    seed: int = 0
    told: Callable[[], None] = lambda: None
    planes: tuple[Mirror, ...] = ()
    _fitted: dict[int, Triangles] = field(default_factory=dict)
    _made: dict[tuple[int, int, int], Candidate] = field(default_factory=dict)

    @staticmethod
    def of(
        triangles: Triangles,
        coded: Coded,
        config: LadderConfig = LadderConfig(),
        seed: int = 0,
        counted: Counted | None = None,
        paint: Paint | None = None,
        told: Callable[[], None] = lambda: None,
        planes: tuple[Mirror, ...] = (),
    ) -> Simplifier:
        """counted: the faces that candidates hold and that are looked for; None: all.

        The others, such as those hidden in bodies, may be found where they are, but are not missed.
        paint: the colors of the materials, where these count.
        Raises MeshError where no face has an area.
        """
        held = None if counted is None else counted.held
        copies = copies_of(triangles, config.copies, held)
        source = Source(copies.triangles)
        same = len(source.triangles) == len(triangles)
        tree = source.tree if same else Tree(triangles.corners)
        original = Original.of(triangles, tree, config.samples, seed, counted, paint)
        return Simplifier(copies, source, original, coded, config, seed, told, planes)

    def fitted(self, faces: int) -> Triangles:
        """About so many triangles, positions fitted; the source itself for as many as it has."""
        if faces not in self._fitted:
            triangles = self.source.triangles
            if faces < len(triangles):
                fewer = self._collapsed(faces)
                placed = fitted_positions(self.source, fewer, self.config.fit, self.seed)
                triangles = shaded(self.source, placed)
            self._fitted[faces] = triangles
        return self._fitted[faces]

    def _collapsed(self, faces: int) -> Triangles:
        """About so many triangles; vertices stay where colors would be lost in a few places."""
        config, triangles = self.config, self.source.triangles
        fewer = collapsed(triangles, faces, config.collapse)
        lost = self._discolored(fewer)
        if not lost.share:
            return fewer
        kept = self.copies.vertices_at(lost.corners, config.copies.tolerance)
        if not 0 < kept.sum() <= config.discolored.most_kept * faces:
            return fewer
        other = collapsed(triangles, faces, config.collapse, kept[triangles.faces])
        return other if self._discolored(other).share < lost.share else fewer

    def _discolored(self, triangles: Triangles) -> Discolored:
        decoded = self.copies.scene(triangles)
        return Discolored.of(self.original, decoded, self.config.discolored)

    def candidate(self, faces: int, bits: int, uv_bits: int) -> Candidate:
        """About so many triangles, rounded, coded and measured."""
        asked = faces, bits, uv_bits
        if asked not in self._made:
            self._made[asked] = self._rounded(*asked)
        return self._made[asked]

    def _rounded(self, faces: int, bits: int, uv_bits: int) -> Candidate:
        parts = self._parts(faces, bits, uv_bits)
        errors = self.original.errors(scene([(mesh_of(part), part.placements) for part in parts]))
        self.told()
        return Candidate(faces, parts, bits, uv_bits, errors, self.coded)

    def _parts(self, faces: int, bits: int, uv_bits: int) -> tuple[MeshPart, ...]:
        if faces >= len(self.source.triangles):
            return _all_of(self._whole, bits, uv_bits)
        triangles = self.fitted(faces)
        grid = Grid.of(triangles.positions, bits)
        triangles = self.copies.rounded(triangles, grid, self.config.rounding, self.seed)
        # UVs are fitted to the places that rounding leaves.
        triangles = fitted_uvs(self.source, triangles, self.config.fit, self.seed)
        return self.copies.parts(triangles, grid, Grid.of(triangles.uvs, uv_bits))

    @cached_property
    def _whole(self) -> Copies:
        """All triangles; those that are mirror images are held once if that takes fewer bytes."""
        triangles = self.copies.triangles
        # Halves do not show any more how edges turn along which they are cut.
        resolved = replace(triangles, creases=bent_creases(triangles))
        plain = replace(self.copies, triangles=resolved)
        halved = with_halves(plain, self.planes, self.config.copies)
        if halved is None:
            return plain
        bits = self.bits_for(self.config.tolerance, whole=True)
        uv_bits = self.uv_bits_for(self.config.uv_tolerance)
        return min(halved, plain, key=lambda each: self.coded(_all_of(each, bits, uv_bits)))

    def balanced(self, faces: int) -> Candidate:
        """About so many faces, with bits whose rounding suits the error that is there before."""
        before = self.original.errors(self.copies.scene(self.fitted(faces)))
        whole = faces >= len(self.source.triangles)
        bits = self.bits_for(max(before.distance, self.config.tolerance), whole)
        uv_bits = self.uv_bits_for(max(before.uv_median, self.config.uv_tolerance))
        return self.candidate(faces, bits, uv_bits)

    def bits_for(self, distance: float, whole: bool = False) -> int:
        """Bits a coordinate whose rounding is the best part of a mean distance.

        whole: where all faces are kept.
        """
        positions, config = self.source.triangles.positions, self.config
        extent = float(np.ptp(positions, axis=0).max())
        return _bits(extent, (config.whole_step if whole else config.step) * distance)

    def uv_bits_for(self, uv: float) -> int:
        """Bits a texture coordinate whose rounding is the best part of a typical UV error."""
        uvs = self.source.triangles.uvs
        extent = float(np.ptp(uvs, axis=0).max()) if len(uvs) else 0.0
        return _bits(extent, self.config.uv_step * uv)


def _all_of(copies: Copies, bits: int, uv_bits: int) -> tuple[MeshPart, ...]:
    triangles = copies.triangles
    grids = Grid.of(triangles.positions, bits), Grid.of(triangles.uvs, uv_bits)
    return copies.parts(triangles, *grids)


def _bits(extent: float, step: float) -> int:
    """The fewest bits whose grid over an extent has at most this step."""
    if extent <= step:
        return 1
    return int(np.clip(np.ceil(np.log2(extent / step + 1)), 1, MAX_GRID_BITS))
