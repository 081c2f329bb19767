"""Bits a weight of `.nisp` files: as the encoder counts them for a target size, and written.

    python -m benchmarks.studies.bits FOLDER [-o benchmarks/results/bits.json]

Predicted: the entropy of a Gaussian of the power of each tensor's symbols, less what draws tell of
them, as in `nispcodec.train.quantize`. Beside it, what rounding every weight one step nearer to
what draws tell would save: the most that a rounding which weighs rate against distortion could
gain, were distortion free.
"""

from __future__ import annotations

from pathlib import Path

import click
import numpy as np

from benchmarks.measuring.field_of import field_of
from benchmarks.measuring.machine import commit
from benchmarks.measuring.result_file import write_result
from nispcodec.core.arrays import Float64Array
from nispcodec.core.network import Network
from nispcodec.format import records, unpack, weights
from nispcodec.format.constants import NETS
from nispcodec.format.container import read_container, write_container
from nispcodec.train.config import QuantizeConfig
from nispcodec.train.quantize import GAUSSIAN_BITS

Record = dict[str, float]


def symbols_of(network: Network) -> list[Float64Array]:
    """The integers of each tensor that are written."""
    every = records.tensors("network", network)
    return [tensor.values(tensor.row_shifts, True).astype(np.float64) for tensor in every]


def entropy(symbols: Float64Array) -> float:
    """Bits of a tensor as the encoder counts them."""
    log_spread = 0.5 * np.log2(np.square(symbols).mean() + 1e-12) + GAUSSIAN_BITS
    return float(symbols.size * np.logaddexp2(0, 2 * log_spread) / 2) + QuantizeConfig.header_bits


def written(network: Network) -> int:
    """Bits in the file, with steps and curves."""
    content = weights.encode({"uv": network}, None)
    return 8 * read_container(write_container([(NETS, True, content)], {}))[0].stored_length


def measured(network: Network) -> Record:
    """Weights, and bits a weight."""
    tensors, count = symbols_of(network), network.spec.weight_count
    nearer = [np.sign(each) * np.maximum(np.abs(each) - 1, 0) for each in tensors]
    predicted = sum(map(entropy, tensors))
    return {
        "weights": count,
        "written": round(written(network) / count, 3),
        "predicted": round(predicted / count, 3),
        "nearer_to_zero_saves": round((predicted - sum(map(entropy, nearer))) / count, 3),
    }


@click.command()
@click.argument("folder", type=click.Path(path_type=Path, exists=True))
@click.option("-o", "--output", type=click.Path(path_type=Path))
def main(folder: Path, output: Path | None) -> None:
    """Print a table of every NAME.nisp in FOLDER; write it as JSON."""
    table: dict[str, dict[str, Record]] = {}
    for path in sorted(folder.glob("*.nisp")):
        document = unpack(path.read_bytes())
        networks = {
            "sdf": field_of(document).sdf,
            "chart": field_of(document).chart,
            "uv": field_of(document).uv,
        }
        table[path.stem] = {name: measured(each) for name, each in networks.items() if each}
        for name, record in table[path.stem].items():
            click.echo(f"{path.stem:<18}{name:<7}{record}")
    if output is not None:
        write_result(output, {"commit": commit(), "assets": table})


if __name__ == "__main__":
    main()
