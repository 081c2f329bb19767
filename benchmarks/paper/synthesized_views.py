"""Table 3 of the paper: views by SRN and by NeRF, trained on views of an asset, beside ours.

    python -m benchmarks.paper.synthesized_views --models DIR --assets ../shared/assets --only spot

DIR holds NAME.nisp. Views are unlit, 128 pixels wide as the paper had them, drawn by one renderer:
those from all around are learned from, those of a turntable are judged by. Both systems are told
the box around the asset, and that all outside is white. Ours sees no views: it is sphere-traced
from the file. What has a result with the same schedule, or for the same file, is not measured
again. Where there is a GPU, --device cuda and many more --steps.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from hashlib import sha256
from pathlib import Path

import click
import numpy as np
import torch

import nispcodec
from benchmarks.measuring.likeness import mean_likeness
from benchmarks.measuring.machine import commit, machine, versions
from benchmarks.measuring.result_file import Record, result_so_far, write_result
from benchmarks.measuring.target import Asked, Target
from benchmarks.paper.nerf import RadianceField
from benchmarks.paper.published import VIEWS as PUBLISHED
from benchmarks.paper.rays import rays_of, tensor
from benchmarks.paper.srn import SceneRepresentation
from benchmarks.paper.unlit import unlit_model
from benchmarks.paper.view_set import ViewSet, view_set
from benchmarks.paper.view_training import Drawer, ViewSchedule, drawn, fit_views
from nispcodec.core.arrays import Float32Array
from nispcodec.core.atomic_write import write_atomic
from nispcodec.format import own_bytes
from nispcodec.io.load import load_mesh
from nispcodec.render.images import image_bytes
from nispcodec.render.views import on_white, render_views

RESULTS = Path("benchmarks/results/paper_synthesized_views.json")
FIGURE, PICTURES = Path("docs/synthesized_views.webp"), Path("build/paper/views")
COUNT, HELD_OUT, SIZE, SEED = 100, 8, 128, 0
SYSTEMS: dict[str, tuple[type[Drawer], ViewSchedule]] = {
    "SRN": (SceneRepresentation, ViewSchedule(steps=1500, rays=512, rate=1e-3)),
    "NeRF": (RadianceField, ViewSchedule(steps=1500, rays=256, rate=2e-3)),
}
ORIGINAL, OURS = "original", "ours"
COLUMNS = (ORIGINAL, OURS, *reversed(SYSTEMS))
TARGETS = [
    Target("PSNR above NeRF's, dB", ("above", "NeRF"), 0, at_least=True),
    Target("PSNR above SRN's, dB", ("above", "SRN"), 0, at_least=True),
]


def asked(results: Record) -> Iterator[Asked]:
    """Of every asset: ours is nearer to the original than either system is."""
    for name, systems in results["assets"].items():
        psnr = {system: record["views"]["psnr"] for system, record in systems.items()}
        ours = psnr.get(OURS, float("-inf"))
        above = {"above": {system: ours - psnr[system] for system in SYSTEMS if system in psnr}}
        yield from (Asked(name, target, above) for target in TARGETS)


def learned(
    system: str, views: ViewSet, schedule: ViewSchedule, device: str
) -> tuple[Record, Float32Array]:
    """Train a system on the views: what came, and the hidden views as it draws them."""
    torch.manual_seed(SEED)
    drawer = SYSTEMS[system][0]().to(device)
    rays, hit = rays_of(views.cameras, SIZE, views.box, device)
    colors = tensor(views.pictures.reshape(-1, 3), device)[hit.to(device)]
    started = time.process_time(), time.monotonic()
    fit_views(drawer, rays, colors, schedule, SEED, _told(system, schedule))
    cost = time.process_time() - started[0], time.monotonic() - started[1]
    rays, hit = rays_of(views.held_out, SIZE, views.box, device)
    pictures = np.ones((len(hit), 3), np.float32)
    pictures[hit.numpy()] = drawn(drawer, rays).cpu().numpy()
    shaped = pictures.reshape(-1, SIZE, SIZE, 3)
    weights = sum(each.numel() for each in drawer.parameters())
    record = {
        "steps": schedule.steps,
        "rays": schedule.rays,
        "device": device,
        "weights": weights,
        "bytes": 4 * weights,
        "processor_seconds": round(cost[0], 1),
        "seconds": round(cost[1], 1),
        "views": mean_likeness(views.hidden, shaped),
    }
    return record, shaped


def _told(system: str, schedule: ViewSchedule) -> Callable[[int, float], None]:
    def tell(step: int, loss: float) -> None:
        if step % 250 == 0:
            click.echo(f"  {system} {step}/{schedule.steps}: {loss:.5f}", err=True)

    return tell


def ours(path: Path, views: ViewSet) -> tuple[Record, Float32Array]:
    """The hidden views, drawn from a file."""
    data = path.read_bytes()
    model = unlit_model(nispcodec.load(path))
    shaped = np.stack([on_white(each) for each in render_views(model, views.held_out, SIZE)])
    record = {
        "model": sha256(data).hexdigest(),
        "bytes": len(data),
        "geometry_uv": own_bytes(data),
        "views": mean_likeness(views.hidden, shaped),
    }
    return record, shaped


class Kept:
    """The records in a file, and beside them the first hidden view as each system draws it."""

    def __init__(self, output: Path, pictures: Path) -> None:
        self.output, self.pictures = output, pictures

    def assets(self) -> dict[str, dict[str, Record]]:
        """Asset -> system -> record."""
        return result_so_far(self.output).get("assets", {})

    def has(self, name: str, system: str, **same: object) -> bool:
        """Whether there is a record of which so much is the same."""
        record = self.assets().get(name, {}).get(system, {})
        return same.items() <= record.items()

    def put(self, name: str, system: str, record: Record) -> None:
        """Keep a record, whatever else was kept in the meantime."""
        assets = self.assets()
        assets.setdefault(name, {})[system] = {"commit": commit(), **record}
        how = {"learned_from": COUNT, "held_out": HELD_OUT, "size": SIZE, "seed": SEED}
        everything = {"machine": machine(), "versions": versions(), **how, "published": PUBLISHED}
        write_result(self.output, everything | {"assets": dict(sorted(assets.items()))})
        click.echo(line(name, system, record))

    def draw(self, name: str, system: str, pictures: Float32Array) -> None:
        """Keep the first of the pictures."""
        self.pictures.mkdir(parents=True, exist_ok=True)
        write_atomic(self._picture(name, system), image_bytes([pictures[0]], ".png"))

    def sheet(self) -> Float32Array:
        """A row for each asset of which there are all pictures, a column for each system."""
        rows = [
            np.concatenate([_read(self._picture(name, system)) for system in COLUMNS], axis=1)
            for name in self.assets()
            if all(self._picture(name, system).exists() for system in COLUMNS)
        ]
        return np.concatenate(rows) if rows else np.ones((1, 1, 3), np.float32)

    def _picture(self, name: str, system: str) -> Path:
        return self.pictures / f"{name}-{system}.png"


def _read(path: Path) -> Float32Array:
    from PIL import Image

    with Image.open(path) as image:
        return np.asarray(image.convert("RGB"), np.float32) / np.float32(255)


def line(name: str, system: str, record: Record) -> str:
    """A line of the table."""
    views = record["views"]
    numbers = f"MSE {views['mse']:7.2f}  PSNR {views['psnr']:.2f} dB  SSIM {views['ssim']:.4f}"
    return f"{name:<18}{system:<6}{record['bytes']:>10,} B  {numbers}"


def measure(kept: Kept, name: str, models: Path, assets: Path, device: str, steps: int) -> None:
    """What is missing of an asset."""
    views = view_set(load_mesh(assets / name / f"{name}.obj"), COUNT, HELD_OUT, SIZE)
    kept.draw(name, ORIGINAL, views.hidden)
    path = models / f"{name}.nisp"
    if not kept.has(name, OURS, model=sha256(path.read_bytes()).hexdigest()):
        record, pictures = ours(path, views)
        kept.draw(name, OURS, pictures)
        kept.put(name, OURS, record)
    for system, (_, usual) in SYSTEMS.items():
        schedule = replace(usual, steps=steps or usual.steps)
        if not kept.has(name, system, steps=schedule.steps, rays=schedule.rays):
            record, pictures = learned(system, views, schedule, device)
            kept.draw(name, system, pictures)
            kept.put(name, system, record)


@click.command()
@click.option("--models", type=click.Path(path_type=Path, exists=True), required=True)
@click.option("--assets", type=click.Path(path_type=Path, exists=True), required=True)
@click.option("--only", multiple=True, required=True, help="An asset; may be repeated.")
@click.option("--device", default="cpu", show_default=True, help="Where torch trains.")
@click.option("--steps", type=click.IntRange(0), default=0, help="In place of the usual ones.")
@click.option("-o", "--output", type=click.Path(path_type=Path), default=RESULTS, show_default=True)
@click.option("--pictures", type=click.Path(path_type=Path), default=PICTURES, show_default=True)
@click.option("--figure", type=click.Path(path_type=Path), default=FIGURE, show_default=True)
def main(
    models: Path,
    assets: Path,
    only: tuple[str, ...],
    device: str,
    steps: int,
    output: Path,
    pictures: Path,
    figure: Path,
) -> None:
    """Measure what is missing, on one core or the device; draw the figure; print the table."""
    torch.set_num_threads(1)
    kept = Kept(output, pictures)
    for name in only:
        measure(kept, name, models, assets, device, steps)
    write_atomic(figure, image_bytes([kept.sheet()], ".webp"))
    for name, systems in kept.assets().items():
        for system, record in systems.items():
            click.echo(line(name, system, record))
    for each in asked({"assets": kept.assets()}):
        click.echo(each.line())


if __name__ == "__main__":
    main()
