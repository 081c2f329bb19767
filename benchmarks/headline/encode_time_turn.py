"""One encode of a bench by turns: what is to be measured, in which order, and what came of it."""

from __future__ import annotations

import json
import math
import os
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from hashlib import sha256
from itertools import product
from pathlib import Path
from typing import Any

from benchmarks.assets.source import Source
from benchmarks.headline.encode_time_table import BUILDS
from benchmarks.measuring.build import Build
from benchmarks.measuring.process import Run, run
from benchmarks.measuring.result_file import Record
from nispcodec.io.load import load_mesh


@dataclass(frozen=True)
class Turn:
    """One encode that is to be measured; `build` is "old" or "new"."""

    asset: str
    preset: str
    seed: int
    round: int
    build: str

    def done(self, runs: Sequence[Record]) -> bool:
        """Whether it has been measured; a failure has not."""
        return any(self.same(each) and "failure" not in each for each in runs)

    def same(self, record: Record) -> bool:
        """Whether a record is of this turn."""
        return all(record[name] == value for name, value in vars(self).items())


def turns(assets: Sequence[str], presets: Sequence[str], seeds: int, rounds: int) -> Iterator[Turn]:
    """Every encode in order, round by round; who is first changes from one pair to the next."""
    for index, (turn, preset, name, seed) in enumerate(
        product(range(rounds), presets, assets, range(seeds))
    ):
        order = BUILDS if (index + turn) % 2 == 0 else BUILDS[::-1]
        yield from (Turn(name, preset, seed, turn, build) for build in order)


def measured(turn: Turn, build: Build, source: Source, runs: Sequence[Record]) -> Record:
    """Time, memory, bytes and errors of one encode; `runs` are those that were measured before."""
    with tempfile.TemporaryDirectory() as folder:
        model, load = Path(folder) / "model.nisp", os.getloadavg()[0]
        encode = _encoded(turn, build, source, model)
        digest = sha256(model.read_bytes()).hexdigest()
        return {
            "seconds": encode.seconds,
            "cpu_seconds": encode.cpu_seconds,
            "peak_bytes": encode.peak_bytes,
            "load": load,
            "bytes": json.loads(encode.stdout)["bytes"]["geometry_uv"],
            "sha256": digest,
            "errors": _known(turn, digest, runs) or errors(build, model, source),
        }


def _encoded(turn: Turn, build: Build, source: Source, model: Path) -> Run:
    settings = ["--preset", turn.preset, "--seed", str(turn.seed), "--json"]
    files = [str(source.path.resolve()), "-o", str(model)]
    return run([*build.command, "encode", *files, *settings], model.parent, build.environment)


def _known(turn: Turn, digest: str, runs: Sequence[Record]) -> Record | None:
    """The errors of the same bytes by the same build; equal seeds give equal files."""
    same = (turn.asset, turn.build, digest)
    known = (each for each in runs if "errors" in each)
    return next((each["errors"] for each in known if _identity(each) == same), None)


def _identity(record: Record) -> tuple[str, str, str]:
    return record["asset"], record["build"], record["sha256"]


def errors(build: Build, model: Path, source: Source) -> dict[str, float]:
    """Of the mesh that the build decodes its file to, by our metrics; UVs where there are any."""
    decoded = model.with_suffix(".glb")
    options = ["--mesh", "-o", str(decoded)]
    run([*build.command, "decode", str(model), *options], model.parent, build.environment)
    return picked(source.reference.compare(load_mesh(decoded)))


def picked(report: Any) -> dict[str, float]:
    """Of a comparison what the table shows; `color` is the RMS error of the base color."""
    found = {"distance": report["geometry"]["larger"]["mean"]}
    if "uv" in report:
        found["uv_median"] = report["uv"]["larger"]["median"]
        found["uv_mean"] = report["uv"]["larger"]["mean"]
    psnr = report["color"]["psnr"]
    return found | ({"color": 10 ** (-psnr / 20)} if math.isfinite(psnr) else {})


def attempt(turn: Turn, build: Build, source: Source, runs: Sequence[Record]) -> Record:
    """The record of one turn, or of how it failed: one failure must not stop the rest."""
    try:
        return {**vars(turn), **measured(turn, build, source, runs)}
    except Exception as why:
        return {**vars(turn), "failure": f"{type(why).__name__}: {why}"}
