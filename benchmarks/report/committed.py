"""Every committed result: its files, the command that writes them, and what its numbers follow."""

from __future__ import annotations

from dataclasses import dataclass

# Folders have been renamed: commits before that touch the former names.
FORMER = (
    "nispcodec/mesh", "nispcodec/fit", "nispcodec/decode", "benchmarks/simplify.py",
    "benchmarks/corners.py",
)  # fmt: skip
MESH, FIT, DECODED, SIMPLIFY, CORNERS = FORMER

CORE = ("nispcodec/core", ":(glob)nispcodec/*.py")
FORMAT = ("nispcodec/format",)
TRAIN = ("nispcodec/geometry", "nispcodec/dataset", "nispcodec/train", MESH, FIT)
ENCODE = (*CORE, *FORMAT, *TRAIN, "nispcodec/encode", "nispcodec/io")
CATALOGUE = ("nispcodec/catalogue",)
INFER = ("nispcodec/infer", DECODED)
DECODE = (*INFER, "nispcodec/extract")
METRICS = ("nispcodec/metrics",)
RENDER = ("nispcodec/render",)
RIVALS = (
    "benchmarks/codecs", "benchmarks/assets/simplify.py", "benchmarks/assets/corners.py",
    "benchmarks/assets/simplify_update.py", "benchmarks/assets/simplify_update.mjs",
    SIMPLIFY, CORNERS,
)  # fmt: skip

UNMEASURED = ("nispcodec/bake", "nispcodec/edit", "nispcodec/procedural")
"""What no committed number follows."""


@dataclass(frozen=True)
class CommittedResult:
    """One result in benchmarks/results.

    depends: paths of the repository whose commits make it older; made_from: the results it is
    worked out from, which are as old as they are; asks: the module whose `asked` has the targets,
    the command's unless told.
    """

    file: str
    command: str
    depends: tuple[str, ...] = ()
    made_from: tuple[str, ...] = ()
    beside: tuple[str, ...] = ()
    asks: str = ""

    @property
    def module(self) -> str:
        """Where the targets are, if there are any."""
        return self.asks or self.command


ROUND_TRIP = (*ENCODE, *DECODE, *METRICS)
"""An asset encoded, decoded and compared."""

RESULTS = (
    CommittedResult("main_job.json", "benchmarks.headline.main_job", (*ROUND_TRIP, *RENDER)),
    CommittedResult("encode_time.json", "benchmarks.headline.encode_time", ROUND_TRIP),
    CommittedResult("best.json", "benchmarks.headline.best", ROUND_TRIP),
    CommittedResult(
        "duel.json", "benchmarks.headline.duel", made_from=("main_job.json", "rivals.json")
    ),
    CommittedResult("totals.json", "benchmarks.headline.totals", (*ROUND_TRIP, *RENDER, *RIVALS)),
    CommittedResult("pictures.json", "benchmarks.headline.pictures", (*ROUND_TRIP, *RENDER)),
    CommittedResult(
        "bench.json",
        "benchmarks",
        (*ROUND_TRIP, *RENDER, *RIVALS),
        beside=("bench.csv",),
        asks="benchmarks.rate_distortion.command",
    ),
    CommittedResult(
        "rivals.json",
        "benchmarks.rate_distortion.rivals",
        (*METRICS, *RIVALS),
        beside=("rivals.csv",),
    ),
    CommittedResult(
        "paper.json",
        "benchmarks.paper",
        (*FORMAT, *INFER),
        made_from=(
            "main_job.json",
            "paper_rendered_views.json",
            "paper_synthesized_views.json",
        ),
        beside=("paper.md",),
        asks="benchmarks.paper.command",
    ),
    CommittedResult("batch.json", "benchmarks.catalogue.speed", (*ENCODE, *CATALOGUE)),
    CommittedResult(
        "batch_bookkeeping.json", "benchmarks.catalogue.bookkeeping", (*CORE, *CATALOGUE)
    ),
    CommittedResult("batch_chaos.json", "benchmarks.catalogue.chaos", (*CORE, *CATALOGUE)),
    CommittedResult("paper_preset.json", "benchmarks.paper.preset", ENCODE),
    CommittedResult("paper_pictures.json", "benchmarks.paper.pictures", (*ROUND_TRIP, *RENDER)),
    CommittedResult(
        "paper_rendered_views.json", "benchmarks.paper.rendered_views", (*ROUND_TRIP, *RENDER)
    ),
    CommittedResult(
        "paper_synthesized_views.json", "benchmarks.paper.synthesized_views", (*ROUND_TRIP, *RENDER)
    ),
    CommittedResult("paper_uv_scatter.json", "benchmarks.paper.uv_scatter", (*ROUND_TRIP, *RENDER)),
    CommittedResult("pruning.json", "benchmarks.paper.pruning", (*TRAIN, *FORMAT)),
    CommittedResult("codings.json", "benchmarks.studies.codings", FORMAT),
    CommittedResult("crossover.json", "benchmarks.studies.crossover", (*ROUND_TRIP, *RIVALS)),
    CommittedResult("curve.json", "benchmarks.studies.curve", ROUND_TRIP),
    CommittedResult("decoder.json", "benchmarks.studies.decoder", ROUND_TRIP),
    CommittedResult("format.json", "benchmarks.studies.format", (*CORE, *FORMAT)),
    CommittedResult("mesh_queries.json", "benchmarks.studies.mesh_queries", (*CORE, *INFER)),
    CommittedResult("mesh_codings.json", "benchmarks.studies.mesh_codings", (*FORMAT, *RIVALS)),
    CommittedResult(
        "mesh_parts.json",
        "benchmarks.studies.mesh_parts",
        (*CORE, "nispcodec/simplify", *FORMAT, *METRICS, *RIVALS),
    ),
    CommittedResult("mixed_forms.json", "benchmarks.studies.mixed_forms", ROUND_TRIP),
    CommittedResult("uv_carriers.json", "benchmarks.studies.uv_carriers", ROUND_TRIP),
    CommittedResult(
        "shading.json",
        "benchmarks.studies.shading",
        (*CORE, "nispcodec/simplify", *FORMAT, *RENDER),
    ),
    CommittedResult(
        "copies.json",
        "benchmarks.studies.copies",
        (*CORE, "nispcodec/geometry", "nispcodec/simplify", *FORMAT, *METRICS, *RIVALS),
    ),
    CommittedResult(
        "pruning_or_quantizing.json",
        "benchmarks.studies.pruning_or_quantizing",
        (*TRAIN, *FORMAT),
    ),
    CommittedResult(
        "decoded_files.json",
        "benchmarks.studies.decoded_files",
        ("nispcodec/extract", "nispcodec/io/write"),
    ),
    CommittedResult(
        "environment_size.json",
        "benchmarks.studies.environment_size",
        ("pyproject.toml", "constraints.txt", "setup.py"),
    ),
    CommittedResult(
        "valid_gltf.json",
        "benchmarks.studies.valid_gltf",
        ("nispcodec/io/write", "nispcodec/extract"),
    ),
    CommittedResult("rounding_loss.json", "benchmarks.studies.rounding_loss", ROUND_TRIP),
    CommittedResult("specks.json", "benchmarks.studies.specks", ROUND_TRIP),
    CommittedResult("training_step.json", "benchmarks.studies.training_step", ("nispcodec/train",)),
    CommittedResult(
        "preparation_time.json",
        "benchmarks.studies.preparation_time",
        (*CORE, "nispcodec/geometry", "nispcodec/dataset"),
    ),
    CommittedResult("random_assets.json", "benchmarks.studies.random_assets", ENCODE),
    CommittedResult("reading.json", "benchmarks.studies.reading", (*CORE, "nispcodec/io")),
    CommittedResult("sdf_grid.json", "benchmarks.studies.sdf_grid", ROUND_TRIP),
    CommittedResult("web_decoder.json", "benchmarks.studies.web_decoder", ("web",)),
    CommittedResult("web_pages.json", "benchmarks.studies.web_pages", ("web",)),
)
