"""Chaos: a batch whose workers and driver are killed at random, on a disk that fills.

    python -m benchmarks.catalogue.chaos [--count 60] [--kills 20] [--seed 0] [-o OUT.json]

COUNT small sample assets, one of which dies and one hangs, by the real encoder with few steps.
First on a quiet run. Then again and again on a small file system in memory, which fills, is made
larger, and the driver or one of its workers is killed after a random time. At the end every good
asset has to be there, verified and equal to the byte, and both bad ones reported. Mounting the
small file system takes the rights to do so; without them the disk does not fill, and the result
says so.
"""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import click

from benchmarks.catalogue.encoders import DIES, HANGS, short
from benchmarks.catalogue.samples import SMALL, write_samples
from benchmarks.catalogue.speed import different
from benchmarks.measuring.machine import commit, machine, versions
from benchmarks.measuring.process import family
from benchmarks.measuring.result_file import Record, write_result
from benchmarks.measuring.target import Asked, Target
from nispcodec.catalogue.batch import Batch
from nispcodec.catalogue.config import BatchConfig
from nispcodec.catalogue.find import find_assets
from nispcodec.core.texture import decode_image
from nispcodec.format.verify import verify

RESULTS = Path("benchmarks/results/batch_chaos.json")
TRIANGLES = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
CRAMPED, ROOMY = "400k", "500m"
"""Of the file system: first too small for all outputs, then not."""
Begin = Callable[[Path], subprocess.Popen[bytes]]
"""Begins a driver in a process of its own, on an output."""
TARGETS = (
    Target("good assets that are missing", ("missing",), 0),
    Target("... that differ", ("different",), 0),
    Target("... that do not verify", ("unsound",), 0),
    Target("bad assets reported", ("reported",), 2, at_least=True),
    Target("kills", ("kills",), 20, at_least=True),
    Target("times that the disk was full", ("disk_full",), 1, at_least=True),
)


def asked(results: Record) -> Iterator[Asked]:
    """The targets of a result file."""
    return (Asked("chaos", target, results) for target in TARGETS)


def drive(source: str, output: str, timeout: float) -> int:
    """The driver: one batch to its end -> 0, or 4 where the disk was full."""
    config = BatchConfig(jobs=2, thumbnail=0, timeout=timeout)
    batch = Batch(output, config=config, encode=short)
    for _ in batch.run(list(find_assets([source]))):
        pass
    return 4 if batch.driver is not None and batch.driver.stopped else 0


def begin(source: Path, timeout: float, output: Path) -> subprocess.Popen[bytes]:
    """A driver in a process of its own."""
    code = "import sys; from benchmarks.catalogue.chaos import drive; "
    code += f"sys.exit(drive({str(source)!r}, {str(output)!r}, {timeout}))"
    return subprocess.Popen([sys.executable, "-c", code], start_new_session=True)


def chaos(begun: Begin, output: Path, kills: int, seed: int, grow: Path | None) -> Record:
    """Runs until there were so many kills, and then to the end; `grow` is what to make larger."""
    dice, killed, full = random.Random(seed), {"driver": 0, "worker": 0}, 0
    driver = begun(output)
    while True:
        enough = sum(killed.values()) >= kills
        code = _ended(driver, None if enough else dice.uniform(0.5, 6))
        if code is None:
            who = _kill(driver, dice)
            if who:
                killed[who] += 1
        elif code == 4 and grow is not None:
            full += 1
            subprocess.run(["mount", "-o", f"remount,size={ROOMY}", str(grow)], check=True)
        elif enough and code == 0:
            return {"kills": sum(killed.values()), "killed": killed, "disk_full": full}
        elif code == 0:
            # All is done before there were enough kills: what is done is made undone.
            for path in sorted(output.rglob("*.nisp"))[::3]:
                path.unlink()
        if driver.poll() is not None:
            driver = begun(output)


def _ended(driver: subprocess.Popen[bytes], seconds: float | None) -> int | None:
    try:
        return driver.wait(seconds)
    except subprocess.TimeoutExpired:
        return None


def _kill(driver: subprocess.Popen[bytes], dice: random.Random) -> str:
    """Kill the driver, one time in three, or one of its workers -> which."""
    workers = family(driver.pid)[1:]
    if dice.random() < 1 / 3:
        driver.kill()
        driver.wait()
        return "driver"
    if not workers:
        return ""
    try:
        os.kill(dice.choice(workers), signal.SIGKILL)
    except ProcessLookupError:
        return ""
    return "worker"


def judged(quiet: Path, output: Path) -> Record:
    """What came of it, against the undisturbed run."""
    good = [path.relative_to(quiet) for path in quiet.rglob("*.nisp")]
    there = [output / path for path in good if (output / path).exists()]
    lines = (output / "catalogue.jsonl").read_text(encoding="utf-8").splitlines()
    records = [json.loads(line) for line in lines]
    bad = [each for each in records if each["status"] != "done"]
    return {
        "good": len(good),
        "missing": len(good) - len(there),
        "different": different(quiet, output),
        "unsound": sum(bool(verify(path.read_bytes(), decode_image)) for path in there),
        "lines": len(records),
        "reported": sum(each["output"].startswith((DIES, HANGS)) for each in bad),
        "failed": {each["output"]: each["error"] for each in bad},
        "half_written": [path.name for path in output.rglob(".*")],
    }


@contextmanager
def small_disk(place: Path) -> Iterator[Path | None]:
    """A small file system at a place, while it is used; None without the rights."""
    place.mkdir(parents=True)
    words = ["mount", "-t", "tmpfs", "-o", f"size={CRAMPED}", "tmpfs", str(place)]
    try:
        mounted = subprocess.run(words, capture_output=True, check=False).returncode == 0
    except OSError:
        mounted = False
    try:
        yield place if mounted else None
    finally:
        if mounted:
            subprocess.run(["umount", str(place)], check=True)


def with_bad_ones(source: Path) -> Path:
    """The assets, and one more that dies and one that hangs."""
    for name in (DIES, HANGS):
        (source / f"{name}.obj").write_text(TRIANGLES)
    return source


@click.command()
@click.option("--count", default=60, show_default=True)
@click.option("--kills", default=20, show_default=True)
@click.option("--seed", default=0, show_default=True)
@click.option("--timeout", default=60.0, show_default=True, help="Seconds for an asset.")
@click.option("-o", "--output", type=click.Path(path_type=Path), default=RESULTS, show_default=True)
def main(count: int, kills: int, seed: int, timeout: float, output: Path) -> None:
    """Run it; print asked against measured."""
    results: Record = {"commit": commit(), "machine": machine(), "versions": versions()}
    results |= {"count": count, "seed": seed, "timeout": timeout}
    with tempfile.TemporaryDirectory() as name, small_disk(Path(name) / "disk") as grow:
        folder, started = Path(name), time.monotonic()
        source = with_bad_ones(write_samples(folder / "in", count - 2, SMALL))
        begun = partial(begin, source, timeout)
        if begun(folder / "quiet").wait():
            raise click.ClickException("the undisturbed run failed")
        results["quiet_seconds"] = round(time.monotonic() - started, 1)
        results |= chaos(begun, folder / "disk", kills, seed, grow)
        results["seconds"] = round(time.monotonic() - started, 1)
        results |= judged(folder / "quiet", folder / "disk")
    write_result(output, results)
    for each in asked(results):
        click.echo(each.line())


if __name__ == "__main__":
    main()
