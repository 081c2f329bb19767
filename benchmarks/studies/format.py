"""Overhead of the container, time to parse and verify a file, time of `nisp info`.

    python -m benchmarks.studies.format [MODEL.nisp ...] [-o benchmarks/results/format.json]

Two files are made for it, of 10 and 50 kB: three networks of normal weights, quantized to six bits
each, 16 charts, one material, one small texture. Models given on the command line are measured
beside them. Verifying begins with parsing, so that its time is that of both. Times are the best of
several; on a busy machine they are longer than they need be, which the time of a loop of a million
empty turns shows (20 to 25 ms when nothing else runs here).
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory

import click
import numpy as np
from PIL import Image

from benchmarks.measuring.machine import commit, machine, versions
from benchmarks.measuring.result_file import Record, as_json, write_result
from benchmarks.measuring.target import Asked, Target, asked_of_each
from nispcodec.core.asset import Material, Texture, TextureMap
from nispcodec.core.document import ChartTable, Document, Field, Frame
from nispcodec.core.network import Network, NetworkSpec
from nispcodec.core.texture import decode_image
from nispcodec.format import inspect, pack, unpack
from nispcodec.format.verify import verify

CHARTS = 16
WIDTHS = {"10 kB": 38, "50 kB": 88}
STEP = 0.0625
PARSES, CALLS = 30, 7
INFO: dict[str, str | int | float | bool] = {
    "preset": "balanced", "seed": 0, "hidden_share": 0.0129, "open_surface_share": 0.0,
    "distance_error": 4.25e-4, "chart_accuracy": 0.992,
    "uv_error_median": 2.47e-4, "uv_error_mean": 1.45e-3,
}  # fmt: skip


def targets(name: str) -> list[Target]:
    """What is asked of a file of one material."""
    times = [
        Target("parse and verify, ms", ("verify_ms",), 20),
        Target("nisp info, ms", ("info_ms",), 400),
    ]
    overhead = Target("other bytes", ("besides_networks_and_images",), 256)
    return [overhead, *times] if name in WIDTHS else [overhead]


def asked(results: Record) -> Iterator[Asked]:
    """The targets of every file of one material in a result file."""
    files = results["files"].items()
    return asked_of_each({name: each for name, each in files if each["materials"] == 1}, targets)


def made(width: int) -> bytes:
    """A file like an encoder's, of networks of four hidden layers of this width."""
    uv = NetworkSpec((width,) * 4, 2, conditioning="chart_affine", charts=CHARTS, embedding=4)
    image = BytesIO()
    Image.new("RGB", (8, 8), "tan").save(image, "PNG")
    table = ChartTable(
        np.zeros(CHARTS, np.int32), np.ones(CHARTS, np.bool_), (-0.25, 0.5), (1.5, 0.75)
    )
    document = Document(
        frame=Frame((0.0, 0.25, 0.5), 1.0),
        materials=(Material("initialShadingGroup", maps={"base_color": TextureMap(0)}),),
        textures=(Texture("spot_texture.png", image.getvalue(), "image/png"),),
        field=Field(
            charts=table,
            sdf=quantized(NetworkSpec((width,) * 4, 1), 0),
            chart=quantized(NetworkSpec((width,) * 3, CHARTS), 1),
            uv=quantized(uv, 2),
        ),
        info=INFO,
    )
    return pack(document)


def quantized(spec: NetworkSpec, seed: int) -> Network:
    """Normal weights of 16 steps' deviation: six bits of entropy each."""
    generator = np.random.default_rng(seed)
    tensors = {
        name: np.rint(generator.normal(0, 16, shape)).astype(np.float32) * np.float32(STEP)
        for name, shape in spec.shapes.items()
    }
    return Network(spec, tensors, dict.fromkeys(tensors, STEP))


def measured(data: bytes) -> Record:
    """Bytes and milliseconds of one file."""
    sections = {section.code: section for section in inspect(data)}
    content = sum(sections[code].stored_length for code in ("NETS", "TXTR") if code in sections)
    document = unpack(data)
    networks = document.networks.values()
    return {
        "bytes": len(data),
        "besides_networks_and_images": len(data) - content,
        "materials": len(document.materials),
        "weights": sum(network.spec.weight_count for network in networks),
        "networks": sections["NETS"].stored_length,
        "order_0_entropy": round(sum(map(entropy, networks))),
        "parse_ms": best_ms(lambda: unpack(data), PARSES),
        "verify_ms": best_ms(lambda: verify(data, decode_image), PARSES),
    }


def entropy(network: Network) -> float:
    """Bytes of all tensors at their own order-0 entropies, which a coder would have to be told."""
    bits = 0.0
    for tensor in network.tensors.values():
        _, counts = np.unique(tensor, return_counts=True)
        bits -= float((counts * np.log2(counts / counts.sum())).sum())
    return bits / 8


def best_ms(call: Callable[[], object], times: int) -> float:
    """Milliseconds of the fastest of several calls."""
    best = float("inf")
    for _ in range(times):
        started = time.perf_counter()
        call()
        best = min(best, time.perf_counter() - started)
    return round(1000 * best, 1)


def info_ms(data: bytes) -> float:
    """Milliseconds of `nisp info` as a process, the fastest of several."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "model.nisp"
        path.write_bytes(data)
        command = [str(Path(sys.executable).with_name("nisp")), "info", str(path)]
        run = partial(subprocess.run, command, check=True, capture_output=True, env=_installed())
        run()
        return best_ms(run, CALLS)


def _installed() -> dict[str, str]:
    """Python keeps its bytecode, as it does where nobody forbids it."""
    return {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}


def empty_loop() -> None:
    """What the machine can do at the moment."""
    for _ in range(1_000_000):
        pass


@click.command()
@click.argument("models", nargs=-1, type=click.Path(path_type=Path, exists=True))
@click.option("-o", "--output", type=click.Path(path_type=Path))
def main(models: tuple[Path, ...], output: Path | None) -> None:
    """Print the numbers as JSON, and what was asked beside what was measured; write them."""
    files = {name: made(width) for name, width in WIDTHS.items()}
    files |= {path.stem: path.read_bytes() for path in models}
    record: Record = {
        "commit": commit(),
        "machine": machine(),
        "versions": versions(),
        "load_average": os.getloadavg()[0],
        "million_turns_ms": best_ms(empty_loop, CALLS),
        "files": {name: measured(data) for name, data in files.items()},
    }
    for name in WIDTHS:
        record["files"][name]["info_ms"] = info_ms(files[name])
    click.echo(as_json(record))
    for each in asked(record):
        click.echo(each.line(), err=True)
    if output is not None:
        write_result(output, record)


if __name__ == "__main__":
    main()
