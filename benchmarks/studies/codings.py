"""Bytes of the paper's two pruned networks in every weight coding, beside the paper's (table 2).

    python -m benchmarks.studies.codings [-o benchmarks/results/codings.json]

Weights are normal and random, the smallest of each matrix pruned: the paper's are not published.
"""

from __future__ import annotations

from pathlib import Path

import click
import numpy as np

from benchmarks.measuring.machine import commit
from benchmarks.measuring.result_file import write_result
from nispcodec.core.network import Network, NetworkSpec
from nispcodec.format import weights
from nispcodec.format.codings.registry import CODINGS
from nispcodec.format.constants import NETS
from nispcodec.format.container import read_container, write_container

DEEP = (64,) * 8
CHARTS = 190
COMPONENT = NetworkSpec(DEEP, CHARTS, "fourier", 5, activation="relu")
UV = NetworkSpec(DEEP, 2, "fourier", 5, "scalar", CHARTS, activation="relu", output="sigmoid")
PRUNED = {"point2component": (COMPONENT, 0.844), "point2UV": (UV, 0.644)}
PAPER = {
    "point2component": {"coo": 54_900, "csc": 54_500, "csr": 55_000, "dia": 58_500},
    "point2UV": {"coo": 71_300, "csc": 71_400, "csr": 71_400, "dia": 73_400},
}
PRECISIONS: dict[str, type[np.floating]] = {"float32": np.float32, "float16": np.float16}


def pruned(spec: NetworkSpec, rate: float, precision: type[np.floating]) -> Network:
    """Normal weights, the smallest of each matrix zero, biases kept."""
    generator = np.random.default_rng(0)
    tensors = {}
    for name, shape in spec.shapes.items():
        values = generator.normal(size=shape).astype(precision).astype(np.float32)
        size = np.abs(values)
        tensors[name] = values * (size >= np.quantile(size, rate if len(shape) == 2 else 0))
    return Network(spec, tensors)


def stored(network: Network, coding: str | None) -> int:
    """Bytes of the network in a file."""
    content = weights.encode({"uv": network}, coding)
    return read_container(write_container([(NETS, True, content)], {}))[0].stored_length


def measured() -> dict[str, dict[str, int]]:
    """Network and precision -> coding -> bytes; "chosen" is the encoder's own choice."""
    return {
        f"{name} {precision}": {
            coding or "chosen": stored(pruned(spec, rate, kind), coding)
            for coding in (*CODINGS, None)
        }
        for name, (spec, rate) in PRUNED.items()
        for precision, kind in PRECISIONS.items()
    }


@click.command()
@click.option("-o", "--output", type=click.Path(path_type=Path))
def main(output: Path | None) -> None:
    """Print a table; write it as JSON."""
    table = measured() | {f"{name}, paper": row for name, row in PAPER.items()}
    click.echo("| | " + " | ".join((*CODINGS, "chosen")) + " |")
    click.echo("|---|" + "---|" * (len(CODINGS) + 1))
    for name in sorted(table):
        cells = (str(table[name].get(coding, "")) for coding in (*CODINGS, "chosen"))
        click.echo(f"| {name} | " + " | ".join(cells) + " |")
    if output is not None:
        write_result(output, {"commit": commit(), "bytes": table})


if __name__ == "__main__":
    main()
