"""Every tuned number of the training, with its unit and the reason for it.

Distances are in the normalized frame (radius 1), UV errors in the network's [0, 1]^2.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise


@dataclass(frozen=True)
class LossConfig:
    """The losses of the networks, and how errors and curvatures are taken.

    near              distances well below this count in full in the relative loss of the SDF
    sign_weight       of the logistic loss of the sign; below 2 the loss is least where the field is
                      the distance, above, near points are pushed away
    sign_softness     how sure of its sign a field should be: about this far from zero
    uv_error_limit    a UV that is further off than this is wrong, however far
    sdf_good          mean distance ...
    chart_good        ... share of wrong charts ...
    uv_good           ... and mean distance in UV that are fine for use: a fit that stays below a
                      few times this has not diverged, however good it was for a moment
    sdf_rounding      the kink of an absolute error of the SDF is taken as if it were as round as
                      this, when weights are rounded ...
    uv_rounding       ... and that of UVs as this
    sure_lead         a chart that leads by so many logits counts as fairly sure
    sdf_damping       share of the mean curvature that is added to each weight's: the less a
                      curvature holds further off, the more ...
    chart_damping     ... for charts
    uv_damping        ... for UVs
    """

    near: float = 0.01
    sign_weight: float = 1.8
    sign_softness: float = 2e-3
    uv_error_limit: float = 0.01
    sdf_good: float = 5e-3
    chart_good: float = 0.02
    uv_good: float = 2e-3
    sdf_rounding: float = 5e-5
    uv_rounding: float = 1e-4
    sure_lead: float = 10.0
    sdf_damping: float = 1e-5
    chart_damping: float = 1e-3
    uv_damping: float = 1e-5


@dataclass(frozen=True)
class MuonConfig:
    """Momentum, of which every matrix is made orthogonal.

    size     root mean square of a step at a rate of 1, without momentum; the longer the steps are
             alike, the farther they lead: the square root of that is made up for
    least    gradients that the momentum holds at least ...
    most     ... and at most: the more, the nearer the fit ends, but with many from the start it
             ends in bad places
    quintic  coefficients of the Newton-Schulz iteration (Jordan et al. 2024)
    rounds   of it
    """

    size: float = 0.7
    least: float = 20.0
    most: float = 400.0
    quintic: tuple[float, float, float] = (3.4445, -4.7750, 2.0315)
    rounds: int = 5


@dataclass(frozen=True)
class SoapConfig:
    """Adam in the eigenbasis of Shampoo's preconditioner (Vyas et al. 2024).

    beta           memory of the moments and covariances
    epsilon        added to the root of the second moment
    refresh_every  steps between two power iterations of the bases
    """

    beta: float = 0.95
    epsilon: float = 1e-8
    refresh_every: int = 10


@dataclass(frozen=True)
class LoopConfig:
    """The training loop.

    warm_up         share of the steps until the full rate: a fit that starts faster may learn |SDF|
                    for good
    final_rate      share of the rate at the end of the cosine
    ema_share       share of the steps that the kept running mean of the weights is over: it is less
                    noisy
    clip            largest norm of a gradient
    checks          how often the held-out error is measured
    chunk           steps between two looks at progress and at other tasks
    loss_memory     of the loss that is shown
    diverged        times the best error, or a good one if that is more, from which on a fit has
                    diverged ...
    settled         ... once this share of the steps is done
    retries         at half the rate, from the best weights
    most_threads    of one fit: a batch has four lanes, more only wait
    useless         times a constant's error from which on a network is not worth writing
    went_wrong      times the held-out error that the probe foresees from which on a fit went wrong:
                    of 98 fits of seven assets all but one stayed below 0.96; that one,
                    with twice its siblings' error, ended at 1.25
    again_unnoticed share of a good error that is no reason to make a fit again
    again_steps     share of the steps when it is made again: with half of them it ended no better
    least_to_judge  times the steps of a probe from which on a fit has to do as well
    """

    warm_up: float = 0.15
    final_rate: float = 0.01
    ema_share: float = 0.01
    clip: float = 1.0
    checks: int = 40
    chunk: int = 25
    loss_memory: float = 0.99
    diverged: float = 4.0
    settled: float = 0.25
    retries: int = 4
    most_threads: int = 16
    useless: float = 4.0
    went_wrong: float = 1.05
    again_unnoticed: float = 0.02
    again_steps: float = 1.0
    least_to_judge: float = 2.0


@dataclass(frozen=True)
class HardExampleConfig:
    """Mining of samples on the wrong side of the SDF.

    error_radius  the nearest sample on the right side is sought no further away than this
    memory        share of a sample's weight that is left at the next mining
    """

    error_radius: float = 0.075
    memory: float = 0.7


@dataclass(frozen=True)
class QuantizeConfig:
    """Rounding of the weights at the end.

    least_samples      points that second derivatives are a mean over, at least ...
    most_samples       ... and at most
    derivatives        points times weights in between: more points where there are few weights
    ridge              share of each weight's own second derivative that is added to it, where there
                       is a point for each weight looked at together; with more points it falls by
                       the square: what few points say of pairs of weights is in part chance
    whole              networks of so many weights are rounded with all pairs looked at together ...
    block              ... larger ones in blocks of so many: memory and time run away beyond
    entries            per-point derivatives in memory at a time
    newton_shares      of Newton's step that are tried: beyond some way the outputs are no longer
                       straight in the weights
    finest, coarsest   bounds of a step
    step_resolution    of candidate steps, in octaves
    tries              with other samples each time, as the samples may overlook what costs most
    slight             times the held-out error that needs no other try ...
    large              ... but for networks of so many weights, whose rounding takes long, ...
    notable            ... which may rise by this before it is tried again
    unnoticed          share of a good error that nobody notices
    spoiled            times the held-out error, or that, that say that a network's curvature was no
                       guide, as after a very short fit: ...
    finer              ... the next try takes so much of its lambda
    """

    least_samples: int = 4_500
    most_samples: int = 10_000
    derivatives: int = 20_000_000
    ridge: float = 8e-3
    whole: int = 3_000
    block: int = 2_520
    entries: int = 2_000_000
    newton_shares: tuple[float, ...] = (0.0, 0.1, 0.3, 1.0)
    finest: float = 1e-6
    coarsest: float = 1e3
    step_resolution: float = 1 / 16
    tries: int = 3
    slight: float = 1.05
    large: int = 8_000
    notable: float = 1.15
    unnoticed: float = 0.1
    spoiled: float = 3.0
    finer: float = 0.03


@dataclass(frozen=True)
class WidthModel:
    """Width = `width` (error of the probe / `error`)^`power`, within `lowest` and `highest`."""

    width: float
    error: float
    power: float
    lowest: int
    highest: int

    def of(self, error: float) -> float:
        """The width for a probe that is left with `error`."""
        width = self.width * (error / self.error) ** self.power
        return min(max(width, self.lowest), self.highest)


@dataclass(frozen=True)
class SizingConfig:
    """How wide and deep an asset's networks are: a model measured on eight assets.

    layers       hidden layers
    narrowest, widest, multiple   widths that networks may have
    bits         that a weight takes in the file at the default lambda: medians of eight assets
    models       width by the error that a probe is left with
    area         with the same error left on a larger surface than this more is to be held ...
    area_power   ... by this power of its size
    fine         an SDF whose probe is left with more is of fine detail: ...
    fine_width   ... so wide, ...
    fine_layers  ... with so many hidden layers in all networks
    """

    layers: int = 4
    narrowest: int = 8
    widest: int = 128
    multiple: int = 2
    bits: Mapping[str, float] = field(default_factory=lambda: {"sdf": 7.0, "chart": 6.4, "uv": 8.6})
    models: Mapping[str, WidthModel] = field(
        default_factory=lambda: {
            "sdf": WidthModel(33, 1.0e-3, 0.7, 22, 34),
            "chart": WidthModel(30, 0.056, 0.6, 16, 44),
            "uv": WidthModel(19.5, 9.3e-4, 0.6, 12, 34),
        }
    )
    area: float = 5.0
    area_power: float = 0.4
    fine: float = 1.8e-3
    fine_width: int = 66
    fine_layers: int = 5


@dataclass(frozen=True)
class NetworkConfig:
    """How one network learns.

    learning_rate        of Muon and SOAP
    momentum_share       share of all gradients so far in the momentum: with more, SDFs lose thin
                         parts
    w0_scale             first frequencies, relative to SIREN's: on most of the surface UVs are all
                         but straight in x, y, z
    last_layer_lr_scale  relative rate of the last layer: the SDF's bias moves the whole field
    step_share           of the steps of a budget: charts gain little from more
    lambda_              how much a bit a weight less may raise the loss, of SDF and UVs relative to
                         what the fit is left with
    probe_hidden         widths of the probe's hidden layers
    """

    learning_rate: float
    momentum_share: float
    w0_scale: float
    last_layer_lr_scale: float
    step_share: float
    lambda_: float
    probe_hidden: tuple[int, ...]


@dataclass(frozen=True)
class TrainingBudget:
    """How much a preset may spend on an asset.

    steps        of the SDF, of all starts; other networks take their share
    starts       fits of an SDF that is not of fine detail, of which the best is kept: a fifth
                 either way is left to chance, and what is beyond 70,000 steps gains less
    scale        of all widths
    minings      of hard examples at least; without them parts go missing that are a small share of
                 the area ...
    mine_every   ... and at least one in so many steps
    w0_scale     first frequencies of the SDF, relative to SIREN's: a short fit needs lower ones, or
                 the SDF is flat for most of it
    samples      share of the samples that are made: making them is a third of the time of a short
                 fit, which sees each one twenty times even so
    rounding     times the held-out error that rounding may cost before it is tried again, if that
                 is more than `QuantizeConfig` says
    trial        steps of a fit by which networks are set against triangles before they are fitted
                 for good, where the probe leaves that open; 0: none
    estimates    candidates of triangles that are looked at before networks are fitted
    mesh         mean distance (normalized frame) that triangles in place of the networks may be
                 off: they are not made coarser, however small they would be
    worth        times the networks' bytes that triangles within `mesh` may take, where networks are
                 further off
    """

    steps: int
    scale: float
    minings: int
    mine_every: int
    w0_scale: float = 1.0
    samples: float = 1.0
    rounding: float = 1.0
    trial: int = 0
    starts: int = 1
    estimates: int = 4
    mesh: float = 6e-4
    worth: float = 1.0


@dataclass(frozen=True)
class PaperConfig:
    """The published networks and rates (paper, sections 3.2 and 4.1).

    hidden          widths of the hidden layers of every network
    levels          of the Fourier features of points
    steps           what twenty minutes on two cores allow of 2000 epochs of 10^6 samples
    batch           samples a step
    sdf_rate, rate  of Adam, for the SDF and for the others
    """

    hidden: tuple[int, ...] = (64,) * 8
    levels: int = 5
    steps: int = 40_000
    batch: int = 2048
    sdf_rate: float = 1e-4
    rate: float = 5e-4


@dataclass(frozen=True)
class TargetConfig:
    """The search for a given error, or for a given size.

    close        how far, relative to it, from an error that was asked for is near enough
    slope        the error falls with this power of the SDF's width, until two fits say better ...
    slopes       ... within these
    rounds       fits at most
    aim          share of a size that networks are aimed at ...
    enough       ... and from which on they are not rounded again
    farthest     octaves by which they may be rounded more coarsely, or more finely, than usual
    roundings    at most, of networks that are fitted once
    least_error  samples, float32 and the extracted mesh are good for no less
    """

    close: float = 0.1
    slope: float = 0.7
    slopes: tuple[float, float] = (0.3, 1.5)
    rounds: int = 5
    aim: float = 0.995
    enough: float = 0.985
    farthest: float = 32.0
    roundings: int = 8
    least_error: float = 2e-5


@dataclass(frozen=True)
class TrainConfig:
    """All of them.

    batch        samples a step: with as long a momentum as Muon's, more and smaller steps do better
    batch_of_outputs   points that are evaluated at a time
    fine_rate    of the SDF of assets of fine detail
    fine_steps   share of the steps of such assets: their networks are eight times as large
    embedding    numbers a chart that the UV network sees
    affine_ridge variance below which a direction decides nothing in the first chart-affine maps
    probe_steps, probe_w0_scale   of the probes
    networks, budgets  how each network learns, and what each preset may spend
    """

    loss: LossConfig = field(default_factory=LossConfig)
    muon: MuonConfig = field(default_factory=MuonConfig)
    soap: SoapConfig = field(default_factory=SoapConfig)
    loop: LoopConfig = field(default_factory=LoopConfig)
    hard_examples: HardExampleConfig = field(default_factory=HardExampleConfig)
    quantize: QuantizeConfig = field(default_factory=QuantizeConfig)
    sizing: SizingConfig = field(default_factory=SizingConfig)
    target: TargetConfig = field(default_factory=TargetConfig)
    paper: PaperConfig = field(default_factory=PaperConfig)
    networks: Mapping[str, NetworkConfig] = field(
        default_factory=lambda: {
            "sdf": NetworkConfig(1e-3, 0.01, 1.0, 0.3, 1.0, 0.06, (24,) * 4),
            "chart": NetworkConfig(3e-3, 0.01, 1.0, 1.0, 0.4, 0.02, (24,) * 3),
            "uv": NetworkConfig(1e-3, 0.04, 2 / 3, 1.0, 1.0, 0.12, (24,) * 4),
        }
    )
    budgets: Mapping[str, TrainingBudget] = field(
        default_factory=lambda: {
            "fast": TrainingBudget(
                9_000, 0.8, 3, 800, 0.7, samples=0.5, rounding=1.25, estimates=2, mesh=1e-3
            ),
            "balanced": TrainingBudget(40_000, 1.0, 9, 2000, trial=8000),
            "best": TrainingBudget(280_000, 1.2, 15, 4000, 0.8, starts=4, mesh=1e-4, worth=3.0),
        }
    )
    batch: int = 1024
    batch_of_outputs: int = 20_000
    fine_rate: float = 5e-4
    fine_steps: float = 0.55
    embedding: int = 4
    affine_ridge: float = 1e-4
    probe_steps: int = 1500
    probe_w0_scale: float = 0.7

    def better_than(self, preset: str) -> str | None:
        """The preset that learns longer; None for the last one and for others than `budgets`."""
        following = dict(pairwise(self.budgets))
        return following.get(preset)
