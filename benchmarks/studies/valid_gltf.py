"""What the Khronos validator says of every glTF that `nisp decode` writes, by option.

    python -m benchmarks.studies.valid_gltf --models DIR [--only spot]

DIR holds NAME.nisp. Wants node, and
`npm install --prefix build/node gltf-validator@2.0.0-dev.3.10`.
"""

from __future__ import annotations

import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import click

from benchmarks.measuring.gltf_validator import issues, lacking
from benchmarks.measuring.model_records import measured
from benchmarks.measuring.result_file import Record
from benchmarks.measuring.target import Asked, Target, asked_of_each

RESULTS = Path("benchmarks/results/valid_gltf.json")
OPTIONS = {
    "plain": "-o out.glb",
    "gltf": "-o out.gltf",
    "faces": "-o out.glb --faces 5000",
    "target-error": "-o out.glb --target-error 1e-3",
    "resolution": "-o out.glb --resolution 128",
    "lods": "-o out.glb --lods 3",
    "draco": "-o out.glb --compress draco",
    "meshopt": "-o out.glb --compress meshopt",
    "quantize": "-o out.glb --compress quantize",
    "gltf, meshopt": "-o out.gltf --compress meshopt",
    "colors": "-o out.glb --colors",
}
"""Names of what is written, and the arguments of `nisp decode`."""
TARGETS = [
    Target("errors", ("errors",), 0),
    Target("warnings", ("warnings",), 0),
    Target("files", ("files",), len(OPTIONS) + 2, at_least=True),
]


def asked(results: Record) -> Iterator[Asked]:
    """The targets of every asset in a result file."""
    return asked_of_each(results["assets"], lambda _: TARGETS)


def validated(model: Path, arguments: str) -> Record:
    """What is said of the files that one decode writes."""
    with TemporaryDirectory() as folder:
        nisp = [sys.executable, "-m", "nispcodec", "decode", str(model.resolve())]
        command = [*nisp, *arguments.split(), "--quiet"]
        subprocess.run(command, cwd=folder, check=True, capture_output=True)
        every = [issues(path) for path in sorted(Path(folder).glob("*.gl*"))]
    codes = Counter(each["code"] for found in every for each in found["messages"])
    return {
        "files": len(every),
        "errors": sum(found["numErrors"] for found in every),
        "warnings": sum(found["numWarnings"] for found in every),
        "codes": dict(sorted(codes.items())),
    }


def measure(model: Path) -> Record:
    """One asset: every option, and the sums of all."""
    found = {name: validated(model, arguments) for name, arguments in OPTIONS.items()}
    sums = {
        key: sum(each[key] for each in found.values()) for key in ("files", "errors", "warnings")
    }
    return {**sums, "options": found}


@click.command()
@click.option("--models", type=click.Path(path_type=Path, exists=True), required=True)
@click.option("--only", multiple=True, help="An asset; may be repeated.")
@click.option("-o", "--output", type=Path, default=RESULTS, show_default=True)
def main(models: Path, only: tuple[str, ...], output: Path) -> None:
    """Validate what is decoded of every NAME.nisp in MODELS; print asked against measured."""
    if why := lacking():
        raise click.ClickException(why)
    records = measured(models, models, only, output, lambda model, _: measure(model))
    for each in asked({"assets": records}):
        click.echo(each.line())


if __name__ == "__main__":
    main()
