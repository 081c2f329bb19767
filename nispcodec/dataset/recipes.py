"""The samples that the networks learn from and are judged by, for each preset."""

from __future__ import annotations

from dataclasses import dataclass, replace

from nispcodec.core.sample_set import SampleSet
from nispcodec.dataset.sampler import Sampler


@dataclass(frozen=True)
class TrainingSets:
    """All samples of one asset, normalized frame.

    distance, charts, uvs    what the SDF, chart and UV network learn from
    held_out_distance        near the surface: what the SDF is judged by
    held_out_surface         on the surface: what charts and UVs are judged by
    undersampled_charts      more for UVs, on patches that are too small to have many
    """

    distance: SampleSet
    charts: SampleSet
    uvs: SampleSet
    held_out_distance: SampleSet
    held_out_surface: SampleSet
    undersampled_charts: SampleSet

    def with_undersampled_charts(self) -> TrainingSets:
        """The sets from which UVs learn small patches too: for networks with room for them."""
        return replace(self, uvs=SampleSet.joined((self.uvs, self.undersampled_charts)))


def training_sets(sampler: Sampler) -> TrainingSets:
    """The samples of all presets but `paper`.

    Most are near the surface; those of the whole cube teach the sign far away. UVs learn from some
    points again where the texture changes, charts where a wrong one shows another color. Raises
    MeshError for a texture that does not decode.
    """
    c = sampler.config
    tight, near_uvs, near_charts = sampler.near_and_nearer(
        c.tight_count,
        c.tight_spread,
        [(c.near_surface_count, spread) for spread in (c.uv_spread, c.chart_spread)],
    )
    closing = sampler.closing_surface(c.closing_count)
    distance = (
        sampler.near_surface(c.near_count, 1 / c.beta),
        tight,
        sampler.cube(c.cube_count),
        sampler.near_surface(c.wide_count, c.wide_spread),
        *sampler.asymmetric(c.asymmetric_count, c.asymmetric_spread) * c.asymmetric_times,
    )
    uvs, charts = (SampleSet.joined((near, closing)) for near in (near_uvs, near_charts))
    return TrainingSets(
        charts=SampleSet.joined((charts, sampler.by_chart_error(charts, c.chart_error_count))),
        held_out_distance=sampler.near_surface(c.held_out_count, c.uv_spread),
        held_out_surface=sampler.surface(c.held_out_count),
        uvs=SampleSet.joined((uvs, sampler.by_texture_gradient(uvs, c.texture_count))),
        undersampled_charts=sampler.undersampled_charts(
            c.least_count, c.near_surface_count, c.uv_spread
        ),
        distance=SampleSet.joined(
            (*distance, sampler.thin_walls(c.thin_count, c.thin_times, c.tight_spread))
        ),
    )


def paper_training_sets(sampler: Sampler) -> TrainingSets:
    """The samples of the preset `paper`: importance samples for all networks (section 4.1).

    These leave most of space unseen, where a fitted SDF then has as much surface again as the
    asset: it learns from samples of the whole cube as well.
    """
    c = sampler.config
    samples = sampler.importance(c.paper_count)
    return TrainingSets(
        distance=SampleSet.joined((samples, sampler.cube(c.cube_count))),
        charts=samples,
        uvs=samples,
        held_out_distance=sampler.near_surface(c.held_out_count, c.uv_spread),
        held_out_surface=sampler.surface(c.held_out_count),
        undersampled_charts=samples[:0],
    )
