"""How to encode: what a user chooses, and the tuned numbers behind it."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from nispcodec.core.errors import NispError
from nispcodec.dataset.config import SamplingConfig
from nispcodec.encode.total_config import CompactConfig, TotalConfig
from nispcodec.geometry.config import GeometryConfig
from nispcodec.simplify.config import DescentConfig, LadderConfig
from nispcodec.train.config import TrainConfig

if TYPE_CHECKING:
    from nispcodec.simplify.errors import Errors
    from nispcodec.train.prune import Pruning

IMAGE_FORMATS = ("webp", "avif", "jpeg")
TEXTURE_FORMATS = ("auto", *IMAGE_FORMATS)
GEOMETRIES = ("auto", "field", "mesh")
ENGINES = ("auto", "native", "torch")
PRESETS = (*TrainConfig().budgets, "paper")


@dataclass(frozen=True)
class EncodeConfig:
    """How to encode.

    preset          one of `PRESETS`
    seed            of everything random: the same input, seed and engine give the
                    same bytes on one kind of processor, with any number of threads
    geometry        "auto": as networks, as triangles, or some bodies as each, whichever is
                    smallest at equal errors;
                    "field": as networks; "mesh": as triangles
    engine          what trains: "native", "torch"; "auto": native wherever that can
    device          "auto", "cpu", "cuda", "cuda:1"; CUDA trains with torch
    threads         cores to use; 0: all
    pad_textures    fills what no face uses of an image with the colors beside it
    texture_format  None keeps the image files as they are; "webp", "avif", "jpeg" re-encode them;
                    "auto" pads them too, and codes colors as AVIF, data as AVIF or without loss
    texture_quality 1 to 100, for a `texture_format` and for images that are padded
    textures        False leaves the images out
    target_size     bytes of the file without its textures, at most; networks or triangles are made
                    to fit, whichever is nearer then
    target_total    bytes of the whole file; images are padded and coded again, none is resized, and
                    the share of images and geometry is chosen by pictures of the asset
    target_error    mean distance to the surface (normalized frame); the SDF is made to fit
    prune           None, "smallest", "smallest_global" or "large_final": lottery tickets
    prune_rate      share of weights to prune, 0 to below 1; or by network: {"sdf": 0.3, "uv": 0.5}
    prune_rounds    in which the rate is reached: each takes as long as an encode

    Raises NispError for a member out of range and for members that exclude each other.
    """

    preset: str = "balanced"
    seed: int = 0
    geometry: str = "auto"
    engine: str = "auto"
    device: str = "auto"
    threads: int = 0
    pad_textures: bool = False
    texture_format: str | None = None
    texture_quality: int = 90
    textures: bool = True
    target_size: float | None = None
    target_total: float | None = None
    target_error: float | None = None
    prune: str | None = None
    prune_rate: float | Mapping[str, float] = 0.5
    prune_rounds: int = 2

    def __post_init__(self) -> None:
        _expect_member("preset", self.preset, PRESETS)
        _expect_member("engine", self.engine, ENGINES)
        _expect_member("geometry", self.geometry, GEOMETRIES)
        if self.texture_format is not None:
            _expect_member("texture format", self.texture_format, TEXTURE_FORMATS)
        _expect_within("texture quality", self.texture_quality, 1, 100)
        _expect_within("seed", self.seed, 0, None)
        _expect_within("threads", self.threads, 0, None)
        if not re.fullmatch(r"auto|cpu|cuda(:\d+)?", self.device):
            raise NispError(f"device: expected auto, cpu, cuda or cuda:N, found {self.device!r}")
        if self.engine == "native" and (self.preset == "paper" or self.device.startswith("cuda")):
            raise NispError("engine native, preset paper, device cuda: expected one of them")
        if self.geometry == "mesh" and (self.preset == "paper" or self.prune):
            raise NispError("geometry mesh, preset paper, prune: expected one of them")
        self._expect_one_target()
        self.prunings()

    def _expect_one_target(self) -> None:
        every = (self.target_size, self.target_total, self.target_error)
        targets = [each for each in every if each is not None]
        if len(targets) > 1 or (targets and self.preset == "paper"):
            raise NispError(
                "target size, target total, target error, preset paper: expected one of them"
            )
        if any(not 0 < each < math.inf for each in targets):
            raise NispError(
                f"target size, total or error: expected more than 0, found {targets[0]:g}"
            )
        if self.target_total and not (self.textures and self.texture_format in (None, "auto")):
            raise NispError("target total: expected the textures, in the format auto or none told")

    def prunings(self) -> dict[str, Pruning]:
        """The pruning of every network that is to be pruned, by its name."""
        from nispcodec.train.prune import prunings

        return prunings(self.prune, self.prune_rate, self.prune_rounds) if self.prune else {}


def _expect_member(name: str, found: str, members: Sequence[str]) -> None:
    if found not in members:
        raise NispError(f"{name}: expected one of {', '.join(members)}, found {found!r}")


def _expect_within(name: str, found: int, low: int, high: int | None) -> None:
    if isinstance(found, bool) or not isinstance(found, int):
        raise NispError(f"{name}: expected a whole number, found {found!r}")
    if found < low or (high is not None and found > high):
        span = f"{low} to {high}" if high is not None else f"{low} or more"
        raise NispError(f"{name}: expected {span}, found {found}")


@dataclass(frozen=True)
class FormConfig:
    """When an asset, or a part of it, is held as triangles, and how near these are.

    Distances are means in the normalized frame, UV errors means in the asset's UV.

    growth           of the faces from one candidate to the next
    bytes_per_face   that candidates typically take: which are looked at first
    estimate_trials  candidates that an estimate looks at, where the preset has time for as many
    far_nearer       times nearer than asked from which on a candidate says no more of how many
                     faces that takes
    bytes_slope      of the bytes by the distance, both as logarithms, as typical
    least_bytes_per_face   no mesh was coded in fewer
    coarseness       of roundings of the unsimplified mesh, against a negligible distance
    surely_smaller   share of the networks' bytes from which down triangles are taken unseen: the
                     estimate of what a fit will reach may be that far off ...
    surely_smaller_fine   ... but for assets of fine detail, whose networks are the largest there
                     are: two such fits ended within an eighth of what the probe said
    surely_best      cost of triangles from which down networks are not looked at: of the eleven
                     assets no networks cost less than 4.8
    surely_larger    share of them from which on networks are
    measured_faces   of the surface of a field at most, when its errors are measured: what a decode
                     spends on thin walls, which a coarser grid tears
    tried_faces      the same of networks that are tried for a half: memory, as all of the asset is
                     there as well
    fitted           share of the probe's error that an SDF of the preset `balanced` is left with
    trial_left       share of the distance after a trial that the whole fit is left with, about
    trial_gain       that the whole fit takes off the cost of a trial: of nine assets eight gained
                     -0.05 to 0.2, and one that was lost either way 1.2
    closer           where triangles win a trial, shares of the foreseen distance at which they are
                     looked for too, in turn, as long as they take no more bytes than networks
    negligible       distances below this are as good as none ...
    negligible_uv    ... and UV errors below this
    distance_weight  of the logarithm of the distance against that of the bytes: halving it is worth
                     a third more bytes
    uv_weight        the same for UV errors
    color_weight     the same for errors of base colors: halving them is worth 15 % more bytes
    negligible_color errors of base colors below this, over their range, are as good as none: 46 dB
    far_weight       the same for surface that is made up or lost: ten times what is warned of is
                     worth an eighth more bytes
    notable_far      share of the area that a form may make up, or lose, before its owner is warned
    sound_growth     of the faces of triangles that make up or lose surface, to the next tried ...
    sound_trials     ... and how often: bytes grow about as much
    most_worth       times a field's bytes that triangles may take at most where it makes up surface
    dense            source faces for each that simplification leaves from which on a body is dense
                     and smooth: networks suit it
    notable_body     share of the triangles' bytes from which on a body may be worth networks
    notable_others   the same of all bodies together that are no sheets and not worth networks of
                     their own, from which on they are worth triangles: networks hold a few more
    least_networks   bytes that no networks of the preset `balanced` stayed below
    worth_mixing     share of the bytes of both pure forms that some bodies as networks and others
                     as triangles may take at most, foreseen
    worth_mixing_tried   the same by what a trial of one half shows, and shares of candidates of the
                     whole: coded by itself the other half takes about a quarter more than its
                     share, and a tie is not worth twice the time
    least_bits       of a coordinate, where a target size asks for grids that coarse
    size_trials      face counts tried for a target size at most
    size_aim         share of a target size that triangles are aimed at: within 3 % is enough
    whole_bits       bits a coordinate, of positions and UVs, of the unsimplified mesh at a target
                     size, against those of a negligible distance and UV error: each step takes 6 to
                     9 % more bytes
    surely_nearer    share of the networks' distance, as the probe foresees it, within which
                     triangles of a target size are taken unseen: fits ended at 0.4 of what was
                     foreseen
    """

    growth: float = 1.8
    bytes_per_face: float = 2.0
    estimate_trials: int = 4
    far_nearer: float = 4.0
    bytes_slope: float = 0.75
    least_bytes_per_face: float = 1.0
    coarseness: tuple[float, ...] = (4.0, 2.0, 1.0)
    surely_smaller: float = 0.5
    surely_smaller_fine: float = 0.8
    surely_best: float = 4.5
    surely_larger: float = 1.4
    measured_faces: float = 500_000
    tried_faces: float = 100_000
    fitted: float = 0.35
    trial_left: float = 0.75
    trial_gain: float = 0.2
    closer: tuple[float, ...] = (0.67, 0.45)
    negligible: float = 1e-4
    negligible_uv: float = 5e-4
    distance_weight: float = 0.4
    uv_weight: float = 0.15
    color_weight: float = 0.2
    negligible_color: float = 5e-3
    far_weight: float = 0.05
    notable_far: float = 5e-4
    sound_growth: float = 1.25
    sound_trials: int = 3
    most_worth: float = 3.0
    dense: float = 3.0
    notable_body: float = 0.03
    notable_others: float = 0.05
    least_networks: float = 3000.0
    worth_mixing: float = 0.9
    worth_mixing_tried: float = 0.68
    least_bits: int = 5
    size_trials: int = 7
    size_aim: float = 0.985
    whole_bits: tuple[tuple[int, int], ...] = (
        (-2, 0), (-1, 0), (0, 0), (0, 1), (1, 1), (1, 2), (2, 2),
    )  # fmt: skip
    surely_nearer: float = 0.25
    ladder: LadderConfig = field(default_factory=LadderConfig)
    descent: DescentConfig = field(default_factory=DescentConfig)

    def is_sound(self, errors: Errors) -> bool:
        """Whether so little is made up and lost that nobody need be warned."""
        return max(errors.made_up.share, errors.lost.share) <= self.notable_far

    def cost(self, size: float, errors: Errors) -> float:
        """The logarithm of bytes, and those of errors as weighted against it."""
        return self.foreseen_cost(size, errors.distance) + self._blemishes(errors)

    def foreseen_cost(self, size: float, distance: float) -> float:
        """The same where of the errors only a mean distance is known."""
        return math.log(size) + self.distance_weight * math.log(max(distance, self.negligible))

    def error_cost(self, errors: Errors) -> float:
        """The weight of errors at equal bytes: logarithms of distance, and of mean and median UV.

        And of colors, as in `cost`. Networks have the better medians, triangles the better means.
        Surface that is made up or lost does not count: a little of it, far away, would outweigh all
        else.
        """
        uvs = [math.log(max(each, self.negligible_uv)) for each in (errors.uv, errors.uv_median)]
        near = max(errors.distance - errors.far_part, self.negligible)
        distance = self.distance_weight * math.log(near)
        return distance + self.uv_weight * sum(uvs) / len(uvs) + self._discoloration(errors)

    def worth(self, errors: Errors) -> float:
        """Times the bytes of a form with these errors that one as near without others may take."""
        return math.exp(self._blemishes(errors))

    def _blemishes(self, errors: Errors) -> float:
        """What wrong colors and surface made up or lost add to the cost; 0 for negligible ones."""
        far = max(errors.made_up.share, errors.lost.share) / self.notable_far
        return self._discoloration(errors) + self.far_weight * math.log1p(far)

    def _discoloration(self, errors: Errors) -> float:
        return self.color_weight * math.log(max(errors.color / self.negligible_color, 1.0))


@dataclass(frozen=True)
class Tuning:
    """Every tuned number of an encode. Tests make them small; users have `EncodeConfig`.

    negligible     share of the radius, and of the UV scale, that nobody sees: a thousandth of what
                   evaluators may differ by; what loses no more is stored in single precision
    notable_open   from this share of the area on, open surfaces are worth the finer extraction that
                   they need
    """

    geometry: GeometryConfig = field(default_factory=GeometryConfig)
    sampling: SamplingConfig = field(default_factory=SamplingConfig)
    training: TrainConfig = field(default_factory=TrainConfig)
    forms: FormConfig = field(default_factory=FormConfig)
    compact: CompactConfig = field(default_factory=CompactConfig)
    total: TotalConfig = field(default_factory=TotalConfig)
    negligible: float = 1e-7
    notable_open: float = 0.02

    def geometry_of(self, preset: str) -> GeometryConfig:
        """The preset `paper` knows neither cut nor merged charts."""
        return replace(self.geometry, merging=None) if preset == "paper" else self.geometry

    def forms_of(self, preset: str) -> FormConfig:
        """With as many looks at triangles as the preset has time for."""
        budget, forms = self.training.budgets.get(preset), self.forms
        most = min(forms.estimate_trials, budget.estimates) if budget else forms.estimate_trials
        return replace(forms, estimate_trials=most)

    def sampling_of(self, preset: str) -> SamplingConfig:
        """The share of the samples that the preset has time to look at."""
        budget = self.training.budgets.get(preset)
        return self.sampling.shared(budget.samples) if budget else self.sampling
