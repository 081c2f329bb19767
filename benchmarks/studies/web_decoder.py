"""The decoder in JavaScript: its bytes, and what it takes to parse, ask and extract, in node.

    python -m benchmarks.studies.web_decoder --models DIR --assets ../shared/assets [--only spot]

DIR holds NAME.nisp for the assets NAME. Wants node, and esbuild and terser by `npm ci` in web/.
Times are processor time of one thread, the least of several runs. Results are kept asset by asset.
"""

from __future__ import annotations

import gzip
import json
import re
import subprocess
from base64 import b64decode
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import click
from nispcodec_web.page import viewer_page

from benchmarks.measuring.build import HERE
from benchmarks.measuring.model_records import measured, models_options
from benchmarks.measuring.result_file import Record
from benchmarks.measuring.target import Asked, Target, asked_of_each
from nispcodec.format import own_bytes

RESULTS = Path("benchmarks/results/web_decoder.json")
WEB = HERE / "web"
MODULE = re.compile(r'"([A-Za-z0-9+/=]{1000,})"')
"""WebAssembly as scripts hold it, in base64: the kernel of networks, and the decoder of meshes."""
DECODER = """
export {{ parseNISP }} from "{web}/decoder/document.js";
export {{ NISPModel }} from "{web}/evaluate/model.js";
export {{ withoutOrientation }} from "{web}/evaluate/images.js";
"""
MESHES = ("./mesh/section.js", "./meshes.js")
"""The modules by which the decoder reaches what mesh parts take."""
TARGETS = [
    Target("parse, s", ("parse_seconds", "least"), 0.02),
    Target("mesh of 128 cells, first, s", ("meshes", "128", "first_seconds"), 1),
    Target("mesh of 256 cells, first, s", ("meshes", "256", "first_seconds"), 3),
]
SPOT = [Target("page without images, bytes", ("page_without_images_bytes",), 120_000)]
FIELDS = [
    Target("SDF queries / plain loops", ("wasm_over_loops",), 15, at_least=True),
    Target("SDF queries a second", ("sdf_points_per_second", "wasm"), 1e6, at_least=True),
]
SIZES = [
    Target("decoder and evaluator, gzip, bytes", ("decoder_gzip_bytes",), 20_000),
    Target("wasm, bytes", ("wasm_bytes",), 10_000),
]


def asked(result: Record) -> Iterator[Asked]:
    """The targets of each asset, of spot, of fields where there is one, and those of sizes."""
    spot = {"spot": result["assets"].get("spot", {})}
    fields = {name: each for name, each in result["assets"].items() if "sdf_layers" in each}
    yield from asked_of_each(result["assets"], lambda _: TARGETS)
    yield from asked_of_each(spot, lambda _: SPOT)
    yield from asked_of_each(fields, lambda _: FIELDS)
    yield from asked_of_each({"decoder": result["sizes"]}, lambda _: SIZES)


@click.command(help=__doc__)
@models_options(RESULTS)
def main(models: Path, assets: Path, only: tuple[str, ...], output: Path) -> None:
    """Measure what is not measured yet."""
    sizes = decoder_sizes()
    records = measured(models, assets, only, output, partial(record, sizes=sizes), sizes=sizes)
    for name, found in records.items():
        click.echo(f"{name}: {found['sdf_points_per_second']}")


def decoder_sizes() -> Record:
    """Bytes of parser and evaluator, the same without mesh parts, packed WebAssembly, the page."""
    whole, fields = (_minified(left_out) for left_out in ((), MESHES))
    script = MODULE.sub("", whole)
    modules = [len(b64decode(each)) for each in MODULE.findall(whole)]
    return {
        "decoder_minified_bytes": len(script),
        "decoder_gzip_bytes": _compressed(script),
        "decoder_of_fields_gzip_bytes": _compressed(MODULE.sub("", fields)),
        "wasm_bytes": sum(modules),
        "wasm_of_meshes_bytes": max(modules),
        "page_bytes": len(viewer_page(b"", "")),
    }


def _minified(left_out: tuple[str, ...]) -> str:
    """The decoder as a program gets it from a bundler: esbuild, then terser."""
    tools = WEB / "node_modules" / ".bin"
    bundler = [str(tools / "esbuild"), "--bundle", "--minify", "--format=esm"]
    with TemporaryDirectory() as name:
        entry = Path(name, "entry.js")
        entry.write_text(DECODER.format(web=WEB))
        command = [*bundler, *(f"--external:{each}" for each in left_out), str(entry)]
        script = subprocess.run(command, capture_output=True, check=True).stdout
    minifier = [str(tools / "terser"), "--module", "-c", "passes=3,unsafe_arrows", "-m"]
    return subprocess.run(minifier, input=script, capture_output=True, check=True).stdout.decode()


def _compressed(script: str) -> int:
    return len(gzip.compress(script.encode(), 9, mtime=0))


def record(model: Path, original: Path, sizes: Record) -> Record:
    """What node says of one file, and how large its page would be without images."""
    script = HERE / "benchmarks" / "studies" / "web_decoder.mjs"
    run = subprocess.run(["node", script, model], capture_output=True, text=True, check=True)
    found: Record = json.loads(run.stdout)
    without = own_bytes(model.read_bytes())
    return {**found, "page_without_images_bytes": sizes["page_bytes"] + -(-without // 3) * 4}


if __name__ == "__main__":
    main()
