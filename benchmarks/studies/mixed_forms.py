"""Where some bodies as networks and others as triangles pay: foreseen, and made.

    python -m benchmarks.studies.mixed_forms --assets ../shared/assets
    python -m benchmarks.studies.mixed_forms --make garden --make still_life

By default what the encoder foresees, for every asset and for two of our own, whatever it then
decides: bytes and mean distance of networks, of triangles, and of dense bodies as networks beside
the others as triangles. With `--make`, assets are encoded as the encoder chooses; triangles are the
fewest bytes found within the errors of what it chose, distance and UV. Seconds are of the
processor. Rows are added to those that the output holds.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import click

import nispcodec
from benchmarks.assets.mixed import garden, still_life
from benchmarks.assets.source import SEED, sources
from benchmarks.measuring.machine import commit, machine, versions
from benchmarks.measuring.result_file import Record, write_result
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.progress import silent
from nispcodec.encode.config import EncodeConfig, Tuning
from nispcodec.encode.field_form import FieldForm
from nispcodec.encode.mesh_form import MeshForm
from nispcodec.encode.split import split
from nispcodec.format import own_bytes, pack
from nispcodec.geometry.analysis import analyze
from nispcodec.train.backend.choice import choose_engine

RESULTS = Path("benchmarks/results/mixed_forms.json")
OWN: dict[str, Callable[[], TexturedMesh]] = {"garden": garden, "still_life": still_life}


def foreseen(mesh: TexturedMesh) -> Record:
    """Bytes and mean distance of three forms of an asset, before any is made."""
    tuning, config = Tuning(), EncodeConfig(seed=SEED)
    forms = tuning.forms
    analysis = analyze(mesh, SEED)
    form = MeshForm(analysis, SEED, forms, silent)
    engine = choose_engine("auto", "auto", False, silent)
    field = FieldForm(analysis, config, tuning, engine, silent)
    size, error = field.foreseen
    estimate = form.estimate(
        forms.fitted * error, forms.surely_smaller * size, forms.surely_larger * size
    )
    found = form.sorted_bodies()
    record: Record = {
        "networks": {"bytes": round(size), "distance": forms.fitted * error},
        "triangles": {"bytes": round(estimate), "distance": forms.fitted * error},
        "dense_share": float(found.dense.mean()),
    }
    halves = split(field, found) if found.dense.any() and found.other.any() else None
    if halves is None:
        return record
    rest, left = halves.field.foreseen
    both = {"bytes": round(rest + found.other_size), "distance": forms.fitted * left}
    return {**record, "both": {**both, "triangles": round(found.other_size)}}


def made(mesh: TexturedMesh) -> Record:
    """Bytes and errors of what the encoder chooses, and of triangles with the same errors."""
    started = time.process_time()
    config = EncodeConfig(seed=SEED, textures=False)
    document = nispcodec.encode(mesh, config).document
    chosen: Record = {
        "held_as": [*document.networks, *["mesh"] * len(document.meshes)],
        "bytes": own_bytes(pack(document)),
        "distance": document.info["distance_error"],
        "uv": document.info.get("uv_error_mean", 0.0),
        "seconds": round(time.process_time() - started, 1),
    }
    record: Record = {"chosen": chosen}
    form = MeshForm(analyze(mesh, SEED), SEED, Tuning().forms, silent)
    best = form.within(float(chosen["distance"]), float(chosen["uv"]))
    if best:
        errors = {"distance": best.errors.distance, "uv": best.errors.uv}
        record["triangles"] = {"bytes": best.size, **errors}
    return record


def meshes(assets: Path | None) -> Iterator[tuple[str, Callable[[], TexturedMesh]]]:
    """The assets in a folder, and those of our own, by name."""
    for source in sources(assets) if assets else []:
        yield source.name, partial(nispcodec.load_mesh, source.path)
    yield from OWN.items()


@click.command()
@click.option("--assets", type=click.Path(path_type=Path, exists=True), help="A folder.")
@click.option("--make", "wanted", multiple=True, help="Assets to encode, in place of foreseeing.")
@click.option("--asset", "names", multiple=True, help="Only these.")
@click.option("-o", "--output", type=click.Path(path_type=Path), default=RESULTS, show_default=True)
def main(
    assets: Path | None, wanted: tuple[str, ...], names: tuple[str, ...], output: Path
) -> None:
    """Print a line for every asset and write all as JSON."""
    known: Record = json.loads(output.read_text(encoding="utf-8")) if output.exists() else {}
    key, measure = ("made", made) if wanted else ("foreseen", foreseen)
    rows = known.get(key, {})
    chosen = wanted or names
    for name, load in meshes(assets):
        if chosen and name not in chosen:
            continue
        rows[name] = measure(load())
        click.echo(f"{name:<24}{rows[name]}")
        where = {"commit": commit(), "machine": machine(), "versions": versions()}
        known |= {**where, key: rows}
        write_result(output, known)


if __name__ == "__main__":
    main()
