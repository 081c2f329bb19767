"""An asset held as triangles: what that costs, and the best of it, found as far as is needed."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np

from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import Document, Field
from nispcodec.core.memory import give_back
from nispcodec.core.mesh_part import MAX_GRID_BITS, MeshPart
from nispcodec.core.progress import Listener, Progress
from nispcodec.encode.bodies import Sorted, sort_bodies
from nispcodec.encode.config import FormConfig
from nispcodec.encode.mesh_size import fewest, nearest_of_size
from nispcodec.encode.part_errors import part_errors
from nispcodec.encode.rungs import Cost, Rungs
from nispcodec.extract.meshing import default_resolution, textured_mesh
from nispcodec.format import mesh
from nispcodec.geometry.analysis import Analysis
from nispcodec.geometry.shown import Shown, shown
from nispcodec.metrics.faulty_points import FaultyPoints
from nispcodec.metrics.paint import Paint
from nispcodec.simplify.descent import least_loss
from nispcodec.simplify.discolored import Discolored
from nispcodec.simplify.errors import Counted, Errors
from nispcodec.simplify.ladder import Candidate, Simplifier
from nispcodec.simplify.mirror import planes_of
from nispcodec.simplify.search import best_for
from nispcodec.simplify.triangles import Triangles, distinct_corners


def coded_bytes(parts: tuple[MeshPart, ...]) -> int:
    """Bytes that parts add to a file."""
    return len(mesh.encode(parts))


@dataclass(frozen=True)
class Rest:
    """All that holds an asset beside a candidate.

    size, errors  bytes, and errors of what they hold
    share         of the asset's area that the candidate has
    """

    size: float
    errors: Errors
    share: float

    def whole(self, candidate: Candidate) -> tuple[float, Errors]:
        """Bytes and errors of the asset."""
        return self.size + candidate.size, candidate.errors.beside(self.errors, self.share)


NOTHING = Rest(0.0, Errors(0.0, 0.0, 0.0, 0.0), 1.0)


class MeshForm:
    """The faces of an asset that can be seen, as candidates for mesh parts.

    Distances are means in the normalized frame, UV errors means in the asset's UV.
    """

    def __init__(
        self, analysis: Analysis, seed: int, config: FormConfig, progress: Listener
    ) -> None:
        self._analysis, self._seed, self._config = analysis, seed, config
        self._progress, self._told = progress, Progress(stage="triangles")
        self._last: tuple[Document, TexturedMesh] | None = None

    @cached_property
    def simplifier(self) -> Simplifier:
        """The maker of candidates, from the faces that can be seen."""
        triangles, counted = self._triangles
        config, seed = self._config.ladder, self._seed
        told = self._tell_candidate
        # Through the middle of the asset, and of the world.
        frame = self._analysis.frame
        planes = planes_of(frame.to_normalized(np.zeros((1, 3)))[0])
        return Simplifier.of(
            triangles, coded_bytes, config, seed, counted, self._paint, told, planes
        )

    @cached_property
    def _paint(self) -> Paint:
        return Paint.of(self._analysis.mesh)

    @cached_property
    def _shown(self) -> Shown:
        return shown(self._analysis)

    @cached_property
    def _triangles(self) -> tuple[Triangles, Counted]:
        """All of them, and which are to be held."""
        found = self._shown
        triangles = Triangles.of(found.mesh, self._analysis.frame, None, found.sheet)
        counted = Counted(found.faces, found.inner)
        return triangles, counted.only(distinct_corners(found.mesh))

    @cached_property
    def _rungs(self) -> Rungs:
        config, slope = self._config, self._config.bytes_slope
        per_face = config.bytes_per_face
        return Rungs(
            self.simplifier,
            config.growth,
            per_face,
            slope,
            config.far_nearer,
            config.estimate_trials,
        )

    def _begin(self, stage: str, steps: int = 0) -> None:
        """Tell of a stage, whose steps are the candidates made; 0: nobody knows how many."""
        self._told = Progress(stage=stage, steps=steps)
        self._progress(self._told)

    def _tell_candidate(self) -> None:
        self._told = replace(self._told, step=self._told.step + 1)
        self._progress(self._told)

    def forget(self) -> None:
        """Free trees of the asset, which grow again for the next question."""
        self.simplifier.source.forget()
        self.simplifier.original.tree.forget()

    def errors(
        self, document: Document, most_faces: float | None = None, stage: str = "surface"
    ) -> Errors:
        """How far the surface that a document decodes to is off, told as this stage.

        As a decode has it, or of at most about so many faces.
        """
        self._progress(Progress(stage=stage, step=0, steps=2))
        decoded = self._decoded(document, most_faces)
        self.forget()
        give_back()
        found = self.simplifier.original.errors(decoded)
        self._progress(Progress(stage=stage, step=1, steps=2))
        return found

    def part_errors(self, document: Document) -> tuple[tuple[float, float], ...]:
        """The mean distance to the original, and the mean UV error, of each part of a document."""
        original, samples = self.simplifier.original, self._config.ladder.samples
        return tuple(part_errors(document, self._decoded(document), original, samples))

    def discolored(self, document: Document) -> FaultyPoints:
        """Where the surface that a document decodes to has other colors than the original's."""
        config = self._config.ladder.discolored
        return Discolored.of(self.simplifier.original, self._decoded(document), config).faulty

    def _decoded(self, document: Document, most_faces: float | None = None) -> TexturedMesh:
        """The decoded mesh, positions in the normalized frame; the last one is kept."""
        if self._last is None or self._last[0] is not document:
            mesh, _ = textured_mesh(document, self._resolution(document.field, most_faces))
            positions = document.frame.to_normalized(mesh.positions)
            self._last = document, replace(mesh, positions=positions)
        return self._last[1]

    @property
    def made(self) -> tuple[Candidate, ...]:
        """The candidates that an estimate has made."""
        return self._rungs.made

    def cheapest(self) -> Candidate:
        """The candidate of least cost: from those made on, as long as it falls."""

        def cost(candidate: Candidate) -> Cost:
            return 0.0, self._config.cost(candidate.size, candidate.errors)

        return self._rungs.cheapest(cost, min(self.made, key=cost).asked)

    def sorted_bodies(self) -> Sorted:
        """By the largest candidate that an estimate has made."""
        candidate, config = self._rungs.largest, self._config
        return sort_bodies(self._shown, self._analysis.frame, candidate, config)

    def _resolution(self, field: Field | None, most_faces: float | None) -> int | None:
        """Cells a side as a decode has them, or fewer where that would take long to measure."""
        if field is None:
            return None
        most = most_faces or self._config.measured_faces
        return default_resolution(field.sdf, field.half_thickness, most_faces=most)

    @property
    def least_cost(self) -> float:
        """The least cost of all faces, were they as coarse as can be and exact all the same."""
        return self._config.foreseen_cost(self._least_bytes, 0.0)

    @property
    def _least_bytes(self) -> float:
        return self._config.least_bytes_per_face * len(self.simplifier.source.triangles)

    def estimate(self, distance: float, few: float, many: float) -> float:
        """About how many bytes the asset takes at a mean distance.

        Most exactly between `few` and `many`.
        """
        self._begin("probe triangles", self._config.estimate_trials)
        return self._rungs.bytes_at(distance, few, many)

    def best(self, most_distance: float, most_bytes: float) -> Candidate:
        """The candidate with the least sum of the logarithms of bytes and errors, as weighted.

        Of those that make up and lose no notable surface, if any; of these, of those within the
        limit of the distance, if any; and of these of those within the limit of the bytes.
        """
        self._begin("triangles")
        found = [*self._rungs.rising(most_bytes, most_distance), *self._whole(most_bytes)]
        sound = [each for each in found if self._config.is_sound(each.errors)] or found
        near = [each for each in sound if each.errors.distance <= most_distance] or sound
        within = [each for each in near if each.size <= most_bytes] or near
        best = min(within, key=partial(_cost, config=self._config))
        return self._refined(best, max(most_distance, best.errors.distance), most_bytes)

    def best_beside(self, rest: Rest) -> Candidate:
        """The candidate that is best for an asset of which networks hold the rest. As `best`."""
        self._begin("triangles")
        config = self._config

        def cost(candidate: Candidate) -> Cost:
            errors = rest.whole(candidate)[1]
            far = max(errors.made_up.share, errors.lost.share)
            return 0.0 if config.is_sound(errors) else far, _cost(candidate, config, rest)

        found = self._rungs.cheapest(cost, rest.size / config.bytes_per_face)
        return self._refined(found, math.inf, math.inf, rest)

    def about(self, distance: float) -> Candidate:
        """A candidate whose mean distance is about this.

        Of a few more faces where surface is made up or lost, until that is not notable.
        """
        self._begin("triangles")
        found = self._sound(self._rungs.about(distance))
        return self._refined(found, max(distance, found.errors.distance), math.inf)

    def nearer(self, found: Candidate, distance: float, most_bytes: float) -> Candidate:
        """A candidate that is about so near, or one of those nearer within the bytes.

        Whichever costs the least.
        """
        good = [found]
        for closer in self._config.closer:
            other = self.about(closer * distance)
            if other.size > most_bytes:
                break
            good.append(other)
        return min(good, key=partial(_cost, config=self._config))

    def _refined(
        self,
        found: Candidate,
        most_distance: float,
        most_bytes: float,
        rest: Rest = NOTHING,
    ) -> Candidate:
        """The same faces with coarser positions and finer UVs, as long as that costs less.

        No surface is lost or made up for it.
        """
        # Bits are cheap: distances down to where rounding need not go count here.
        config = replace(self._config, negligible=self._config.ladder.tolerance)
        for fewer, more in ((1, 0), (0, 1)):
            best, bits, uv_bits = found, found.bits - fewer, found.uv_bits + more
            while min(bits, MAX_GRID_BITS - uv_bits) >= 1:
                other = self.simplifier.candidate(found.asked, bits, uv_bits)
                large = other.size > max(most_bytes, best.size)
                if large or other.errors.distance > most_distance:
                    break
                if _cost(other, config, rest) >= _cost(best, config, rest):
                    break
                if self._config.is_sound(best.errors) > self._config.is_sound(other.errors):
                    break
                best, bits, uv_bits = other, bits - fewer, uv_bits + more
            found = best
        return found

    def _whole(self, most_bytes: float) -> Iterator[Candidate]:
        """Every face, rounded to smaller and smaller errors, up to so many bytes."""
        everything = len(self.simplifier.source.triangles)
        if self._least_bytes > most_bytes:
            return
        uv_bits = self.simplifier.uv_bits_for(self._config.negligible_uv)
        for coarseness in self._config.coarseness:
            bits = self.simplifier.bits_for(coarseness * self._config.negligible, whole=True)
            found = self.simplifier.candidate(everything, bits, uv_bits)
            yield found
            if found.size > most_bytes:
                return

    def within(self, distance: float, uv: float) -> Candidate | None:
        """The fewest bytes at these errors at most; None where there is no such candidate."""
        self._begin("triangles")
        return best_for(self.simplifier, distance, uv)

    def of_size(self, most_bytes: float) -> Candidate:
        """The nearest candidate found of at most so many bytes; the smallest where none is."""
        self._begin("triangles")
        return nearest_of_size(self.simplifier, most_bytes, self._config)

    def of_least_loss(self, loss: Callable[[Candidate], float]) -> Candidate:
        """The candidate that loses least, of those a search looks at: by pictures, say."""
        self._begin("triangles")
        return least_loss(self.simplifier, loss, self._config.descent)

    def _sound(self, found: Candidate) -> Candidate:
        """The first of the same and a few more faces that neither loses nor makes up surface."""
        everything, faces = len(self.simplifier.source.triangles), float(found.asked)
        for _ in range(self._config.sound_trials + 1):
            other = self._rungs.at(round(min(faces, everything)))
            if self._config.is_sound(other.errors):
                return other
            faces *= self._config.sound_growth
        return found

    def fewest(self) -> Candidate:
        """The candidate of the fewest faces that are made."""
        return fewest(self.simplifier)


def _cost(candidate: Candidate, config: FormConfig, rest: Rest = NOTHING) -> float:
    size, errors = rest.whole(candidate)
    uv = config.uv_weight * math.log(max(errors.uv, config.negligible_uv))
    return config.cost(size, errors) + uv
