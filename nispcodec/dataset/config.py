"""Every tuned number of the training samples, with its unit and the reason for it.

Lengths are in the normalized frame (radius 1).
"""

from __future__ import annotations

from dataclasses import dataclass, replace


@dataclass(frozen=True)
class SamplingConfig:
    """How many samples of each kind, and how close to the surface.

    beta                importance exp(-beta |SDF|) of a sample (paper, eq. 5)
    near_count          samples with the paper's density, for the SDF
    tight_count         samples that sharpen the zero set ...
    tight_spread        ... at this mean distance
    wide_count          samples for the insides of bodies, of which the cube's are few ...
    wide_spread         ... at this mean distance
    cube_count          samples of the whole cube, for the sign far away
    asymmetric_count    points whose mirror images are looked at, of nearly symmetric assets ...
    asymmetric_spread   ... at this mean distance
    asymmetric_times    how often each that differs is learned from: if once, a large part shows on
                        the other side too
    thin_count          surface points that are looked at for thin parts
    thin_times          samples for each of these that is on one, beside its usual four
    thin_depth          what ends less than a quarter of this deeper than it is thin
    near_surface_count  samples for charts and UVs, each
    uv_spread           mean distance of those for UVs: what is far from the surface is nobody's to
                        ask
    chart_spread        the same for charts: about as far as a decoded surface is off; decisions
                        beyond are wasted
    texture_count       UV samples again where the texture changes ...
    texture_step        ... over this distance in UV, a few times as far as UV networks err
    chart_error_count   chart samples again where a wrong chart shows another color ...
    chart_neighbors     ... than as many samples around: those that a network may take it for
    chart_looks         samples by which it is told how far the nearest of these are, at most
    closing_count       samples on surfaces that close openings ...
    closing_jitter      ... up to this far off them, as a network may put them
    least_count         UV samples that every patch gets, where networks have room for small ones
    held_out_count      samples that networks are judged by
    paper_count         importance samples of the preset `paper`
    """

    beta: float = 60.0
    near_count: int = 80_000
    tight_count: int = 240_000
    tight_spread: float = 1 / 300
    wide_count: int = 40_000
    wide_spread: float = 1 / 12
    cube_count: int = 80_000
    asymmetric_count: int = 80_000
    asymmetric_spread: float = 1 / 100
    asymmetric_times: int = 8
    thin_count: int = 60_000
    thin_times: int = 16
    thin_depth: float = 4e-3
    near_surface_count: int = 250_000
    uv_spread: float = 3e-3
    chart_spread: float = 1.5e-3
    texture_count: int = 110_000
    texture_step: float = 2e-3
    chart_error_count: int = 125_000
    chart_neighbors: int = 16
    chart_looks: int = 1000
    closing_count: int = 12_000
    closing_jitter: float = 5e-3
    least_count: int = 150
    held_out_count: int = 20_000
    paper_count: int = 1_000_000

    def shared(self, share: float) -> SamplingConfig:
        """With this share of all samples that sine networks learn from; as many to judge them."""
        counts = {name: max(1, round(share * getattr(self, name))) for name in _LEARNED_FROM}
        return replace(self, **counts)


_LEARNED_FROM = tuple(
    f"{kind}_count"
    for kind in (
        *("near", "tight", "wide", "cube", "asymmetric", "thin", "near_surface"),
        *("texture", "chart_error", "closing"),
    )
)
