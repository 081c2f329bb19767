"""Which samples the networks learn from and are judged by, for each preset."""

from __future__ import annotations

from dataclasses import dataclass, replace

from nispcodec.dataset.sample_set import SampleSet
from nispcodec.dataset.sampler import BETA, Sampler

TIGHT = 1 / 300
"""Mean distance (normalized frame) of the samples that sharpen the zero set."""

WIDE = 1 / 12
"""Mean distance of the samples for the insides of bodies, of which the cube's are few."""

UNLIKE = 1 / 100
"""As TIGHT, for what is on one side only of a nearly symmetric asset."""

SKIN = 3e-3
"""Mean distance of the samples for UVs: what is far from the surface is nobody's to ask."""

CLOSE = 1.5e-3
"""The same for charts: about as far as a decoded surface is off. Decisions beyond are wasted."""

UNLIKE_TIMES = 8
"""How often each of these is learned from: if once, a large part shows on the other side too."""

THIN_TIMES = 16
"""How many samples each point of THIN_COUNT that is on a thin part gets, beside its own four."""

NEAR_COUNT = 80_000
TIGHT_COUNT = 240_000
CUBE_COUNT = 80_000
WIDE_COUNT = 40_000
UNLIKE_COUNT = 80_000
THIN_COUNT = 60_000
SKIN_COUNT = 250_000
DETAIL_COUNT = 110_000
CONFUSING_COUNT = 125_000
MEMBRANE_COUNT = 12_000
LEAST_COUNT = 150
HELD_OUT_COUNT = 20_000
PAPER_COUNT = 1_000_000


@dataclass(frozen=True)
class TrainingSets:
    """Samples to fit the SDF (`distance`), charts and UVs (`textured`); held-out ones.

    `scarce`: more for UVs, of patches that are too small to have many.
    """

    distance: SampleSet
    charts: SampleSet
    held_distance: SampleSet
    held_skin: SampleSet
    textured: SampleSet
    scarce: SampleSet

    def with_scarce(self) -> TrainingSets:
        """UVs learn small patches too: for networks with room for them."""
        return replace(self, textured=SampleSet.joined((self.textured, self.scarce)))


def training_sets(sampler: Sampler) -> TrainingSets:
    """Near the surface for the most part; the whole cube for the sign far away.

    UVs learn from some points again where the texture has detail, charts where they show different
    colors.
    """
    distance = (
        sampler.near(NEAR_COUNT, 1 / BETA),
        sampler.near(TIGHT_COUNT, TIGHT),
        sampler.cube(CUBE_COUNT),
        sampler.near(WIDE_COUNT, WIDE),
        *sampler.unlike(UNLIKE_COUNT, UNLIKE) * UNLIKE_TIMES,
    )
    skin, close = (
        SampleSet.joined(
            (sampler.near(SKIN_COUNT, spread, signed=False), sampler.membrane(MEMBRANE_COUNT))
        )
        for spread in (SKIN, CLOSE)
    )
    return TrainingSets(
        charts=SampleSet.joined((close, sampler.confusing(close, CONFUSING_COUNT))),
        held_distance=sampler.near(HELD_OUT_COUNT, SKIN),
        held_skin=sampler.surface(HELD_OUT_COUNT),
        textured=SampleSet.joined((skin, sampler.detailed(skin, DETAIL_COUNT))),
        scarce=sampler.scarce(LEAST_COUNT, SKIN_COUNT, SKIN),
        distance=SampleSet.joined((*distance, sampler.thin(THIN_COUNT, THIN_TIMES, TIGHT))),
    )


def paper_training_sets(sampler: Sampler) -> TrainingSets:
    """The paper's: importance samples for all networks, judged on the surface (section 4.1).

    They leave most of space untold, where a fitted SDF then has as much surface again as the asset:
    it sees the cube's samples as well.
    """
    samples = sampler.importance(PAPER_COUNT)
    distance = SampleSet.joined((samples, sampler.cube(CUBE_COUNT)))
    held_out = sampler.near(HELD_OUT_COUNT, SKIN), sampler.surface(HELD_OUT_COUNT)
    return TrainingSets(distance, samples, *held_out, samples, samples[:0])
