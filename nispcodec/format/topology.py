"""Network topologies in META: the part of each `NetworkSpec` that the file does not imply."""

from __future__ import annotations

from typing import Any

from nispcodec.core.errors import FormatError
from nispcodec.core.network import ACTIVATIONS, CONDITIONINGS, ENCODINGS, OUTPUTS, NetworkSpec
from nispcodec.format.constants import META, NETWORKS
from nispcodec.format.record import Record, located, number, sparse


def encode(specs: dict[str, NetworkSpec]) -> dict[int, Any]:
    """Specs by network name -> {network number: its map in META}.

    Raises FormatError for a conditioning that only UV networks may have.
    """
    return {
        1 + NETWORKS.index(name): _fields(f"networks.{name}", spec) for name, spec in specs.items()
    }


def decode(record: Record, charts: int) -> dict[str, NetworkSpec]:
    """The specs by network name, in the order of `NETWORKS`; `charts` is the number of charts.

    Raises FormatError for malformed fields and without an SDF network.
    """
    specs = {
        name: _read(Record(META, f"networks.{name}", record.take(key, name, dict)), name, charts)
        for key, name in enumerate(NETWORKS, 1)
        if key in record
    }
    record.finish()
    if "sdf" not in specs:
        raise record.error("sdf", "present", "absent")
    return specs


def _fields(path: str, spec: NetworkSpec) -> dict[int, Any]:
    if path != "networks.uv" and spec.conditioning != "none":
        raise FormatError(META, f"{path}.conditioning", "none", spec.conditioning)
    return sparse(
        {
            1: (list(spec.hidden), None),
            2: (number(META, f"{path}.encoding", spec.encoding, ENCODINGS), 1),
            3: (spec.levels, 0),
            4: (number(META, f"{path}.conditioning", spec.conditioning, CONDITIONINGS), 1),
            5: (spec.embedding, 0),
            6: (number(META, f"{path}.activation", spec.activation, ACTIVATIONS), 1),
            7: (float(spec.w0), 30.0),
            8: (number(META, f"{path}.output", spec.output, OUTPUTS), 1),
            9: (spec.mirror, 0),
            10: (spec.init_seed, 0),
        }
    )


def _read(record: Record, name: str, charts: int) -> NetworkSpec:
    hidden = record.take(1, "hidden", list)
    if not all(type(width) is int for width in hidden):
        raise record.error("hidden", "integers", "another type")
    encoding = record.member(2, "encoding", ENCODINGS)
    levels = record.take(3, "levels", int, 0)
    conditioning = record.member(4, "conditioning", CONDITIONINGS)
    if name != "uv" and conditioning != "none":
        raise record.error("conditioning", "none", conditioning)
    embedding = record.take(5, "embedding", int, 0)
    activation = record.member(6, "activation", ACTIVATIONS)
    w0 = record.take(7, "w0", float, 30.0)
    output = record.member(8, "output", OUTPUTS)
    mirror = record.take(9, "mirror", int, 0)
    init_seed = record.take(10, "init_seed", int, 0)
    with located(META, record.path):
        spec = NetworkSpec(
            hidden=tuple(hidden),
            outputs={"sdf": 1, "chart": charts, "uv": 2}[name],
            encoding=encoding,
            levels=levels,
            conditioning=conditioning,
            charts=0 if conditioning == "none" else charts,
            embedding=embedding,
            activation=activation,
            w0=w0,
            output=output,
            mirror=mirror,
            init_seed=init_seed,
        )
    record.finish()
    return spec
