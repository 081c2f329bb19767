"""Which samples the networks learn from and are judged by, for each preset."""

from __future__ import annotations

from dataclasses import dataclass

from nispcodec.mesh.sample_set import SampleSet
from nispcodec.mesh.samples import BETA, Sampler

TIGHT = 1 / 300
"""Mean distance (normalised frame) of the samples that sharpen the zero set."""

WIDE = 1 / 12
"""Mean distance of the samples for the insides of bodies, of which the cube's are few."""

UNLIKE = 1 / 100
"""As TIGHT, for what is on one side only of a nearly symmetric asset."""

SKIN = 3e-3
"""Mean distance of the samples for charts and UVs: decisions far from the surface are wasted."""

NEAR_COUNT = 80_000
TIGHT_COUNT = 240_000
CUBE_COUNT = 80_000
WIDE_COUNT = 40_000
UNLIKE_COUNT = 80_000
SKIN_COUNT = 250_000
DETAIL_COUNT = 110_000
CONFUSING_COUNT = 125_000
MEMBRANE_COUNT = 12_000
HELD_OUT_COUNT = 20_000
PAPER_COUNT = 1_000_000


@dataclass(frozen=True)
class TrainingSets:
    """Samples to fit the SDF (`distance`), charts and UVs (`textured`); held-out ones."""

    distance: SampleSet
    charts: SampleSet
    held_distance: SampleSet
    held_skin: SampleSet
    textured: SampleSet


def training_sets(sampler: Sampler) -> TrainingSets:
    """Near the surface for the most part; the whole cube for the sign far away.

    UVs learn from some points again where the texture has detail, charts where they show different
    colours.
    """
    distance = (
        sampler.near(NEAR_COUNT, 1 / BETA),
        sampler.near(TIGHT_COUNT, TIGHT),
        sampler.cube(CUBE_COUNT),
        sampler.near(WIDE_COUNT, WIDE),
        *sampler.unlike(UNLIKE_COUNT, UNLIKE),
    )
    skin = SampleSet.joined(
        (sampler.near(SKIN_COUNT, SKIN, signed=False), sampler.membrane(MEMBRANE_COUNT))
    )
    return TrainingSets(
        distance=SampleSet.joined(distance),
        charts=SampleSet.joined((skin, sampler.confusing(skin, CONFUSING_COUNT))),
        held_distance=sampler.near(HELD_OUT_COUNT, SKIN),
        held_skin=sampler.surface(HELD_OUT_COUNT),
        textured=SampleSet.joined((skin, sampler.detailed(skin, DETAIL_COUNT))),
    )


def paper_training_sets(sampler: Sampler) -> TrainingSets:
    """The paper's: importance samples for all networks, judged on the surface (section 4.1).

    They leave most of space untold, where a fitted SDF then has as much surface again as the asset:
    it sees the cube's samples as well.
    """
    samples = sampler.importance(PAPER_COUNT)
    distance = SampleSet.joined((samples, sampler.cube(CUBE_COUNT)))
    surface = sampler.surface(HELD_OUT_COUNT)
    return TrainingSets(distance, samples, sampler.near(HELD_OUT_COUNT, SKIN), surface, samples)
