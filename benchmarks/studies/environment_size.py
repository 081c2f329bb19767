"""What a fresh environment takes on disk, by what it is for.

    python -m benchmarks.studies.environment_size

Each is made by venv and pip from this checkout and the pinned constraints; needs their registry.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import click

from benchmarks.measuring.build import HERE
from benchmarks.measuring.machine import commit, machine
from benchmarks.measuring.result_file import Record, write_result
from benchmarks.measuring.target import Asked, Target, asked_of_each

RESULTS = Path("benchmarks/results/environment_size.json")
EXTRAS = {"decoding": "", "encoding": "[encode]", "encoding and pictures": "[encode,render]"}
"""Names of what an environment is for, and the extras that pip is asked for."""
MOST = {"encoding": 400e6}


def asked(results: Record) -> Iterator[Asked]:
    """The targets of every environment in a result file."""
    return asked_of_each(results["environments"], targets)


def targets(name: str) -> list[Target]:
    """What is asked of one environment."""
    return [Target("fresh environment, bytes", ("bytes",), MOST[name])] if name in MOST else []


def measure(extras: str) -> Record:
    """Bytes and packages of an environment with the library and these extras."""
    with TemporaryDirectory() as folder:
        python = Path(folder) / "bin" / "python"
        subprocess.run([sys.executable, "-m", "venv", folder], check=True)
        pip = [str(python), "-m", "pip", "--disable-pip-version-check"]
        pinned = ["-c", str(HERE / "constraints.txt")]
        subprocess.run([*pip, "install", "-q", *pinned, f"{HERE}{extras}"], check=True)
        listed = subprocess.run([*pip, "list", "--format=freeze"], check=True, capture_output=True)
        packages = listed.stdout.decode().split()
        return {"bytes": on_disk(Path(folder)), "packages": packages}


def on_disk(folder: Path) -> int:
    """Bytes of all files below a folder, links not followed."""
    return sum(each.lstat().st_size for each in folder.rglob("*") if not each.is_dir())


@click.command()
@click.option("-o", "--output", type=Path, default=RESULTS, show_default=True)
def main(output: Path) -> None:
    """Make each environment, print and write what it takes."""
    found = {name: measure(extras) for name, extras in EXTRAS.items()}
    results = {"commit": commit(), "machine": machine(), "environments": found}
    write_result(output, results)
    for name, each in found.items():
        click.echo(f"{name:<24}{each['bytes'] / 1e6:>8,.0f} MB  {len(each['packages'])} packages")


if __name__ == "__main__":
    main()
