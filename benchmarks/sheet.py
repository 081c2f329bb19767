"""One picture of original, decode and difference from several views, with the numbers.

python -m benchmarks.sheet original.obj decoded.glb -o sheet.png
"""

from __future__ import annotations

from pathlib import Path

import click
import numpy as np
import PIL.Image
import PIL.ImageDraw
import PIL.ImageFont
from numpy.typing import NDArray

from benchmarks.render import Camera, Picture, Scene, turntable
from nispcodec.asset import TexturedMesh
from nispcodec.decode.model import NispModel
from nispcodec.format import unpack
from nispcodec.mesh.load import load_mesh
from nispcodec.metrics.compare import compare
from nispcodec.metrics.pictures import compare_pictures
from nispcodec.metrics.surface import frame_of

GAIN = 4
CLOSE_UP = 7.0
MARGIN = 26


def read_asset(path: Path) -> TexturedMesh:
    """A mesh file, or a `.nisp` decoded at its default resolution."""
    if path.suffix.lower() == ".nisp":
        return NispModel(unpack(path.read_bytes())).to_mesh()
    return load_mesh(path)


def cameras(scene: Scene) -> list[Camera]:
    """Four views around, and a close-up of what the first one has in its centre."""
    around = turntable()
    first = around[0]
    rays = first.rays(65)
    _, points = scene.hits(np.asarray(first.eye), rays)
    nearest = points.positions[np.argmin(np.linalg.norm(points.positions, axis=1))]
    target = (float(nearest[0]), float(nearest[1]), float(nearest[2]))
    return [*around, Camera(first.eye, target, CLOSE_UP)]


def sheet(original: TexturedMesh, decoded: TexturedMesh, size: int) -> PIL.Image.Image:
    """Three rows of pictures: original, decoded, difference times GAIN; numbers on top."""
    frame = frame_of(original)
    scenes = Scene(original, frame), Scene(decoded, frame)
    views = cameras(scenes[0])
    rows = [[scene.render(view, size) for view in views] for scene in scenes]
    pairs = list(zip(*rows, strict=True))
    differences = [1 - np.clip(np.abs(a - b) * GAIN, 0, 1) for a, b in pairs]
    image = PIL.Image.fromarray(_bytes([*rows, differences]))
    return _labelled(image, _numbers(original, decoded, pairs))


def _numbers(
    original: TexturedMesh, decoded: TexturedMesh, pairs: list[tuple[Picture, Picture]]
) -> str:
    report = compare(original, decoded)
    pictures = [compare_pictures(*pair) for pair in pairs]
    psnr, ssim = (float(np.mean([each[name] for each in pictures])) for name in ("psnr", "ssim"))
    text = f"{original.name}: {len(original.faces):,} faces -> {len(decoded.faces):,}"
    text += f"   pictures {psnr:.1f} dB, SSIM {ssim:.3f}"
    distance, uv = report["geometry"]["larger"], report.get("uv", {}).get("larger")
    if isinstance(distance, dict):
        text += f"   distance mean {distance['mean']:.1e} p99 {distance['p99']:.1e}"
    if isinstance(uv, dict):
        text += f"   UV median {uv['median']:.1e}"
    return text


def _bytes(rows: list[list[Picture]]) -> NDArray[np.uint8]:
    whole: Picture = np.concatenate([np.concatenate(row, axis=1) for row in rows], axis=0)
    return (np.clip(whole, 0, 1) * np.float32(255) + np.float32(0.5)).astype(np.uint8)


def _labelled(image: PIL.Image.Image, text: str) -> PIL.Image.Image:
    page = PIL.Image.new("RGB", (image.width, image.height + MARGIN), "white")
    page.paste(image, (0, MARGIN))
    pen, font = PIL.ImageDraw.Draw(page), PIL.ImageFont.load_default(size=14)
    pen.text((6, 5), text, fill="black", font=font)
    for row, name in enumerate(("original", "decoded", f"difference x{GAIN}")):
        height = MARGIN + row * image.height // 3
        pen.text((6, height + 2), name, fill=(110, 110, 110), font=font)
    return page


@click.command()
@click.argument("original", type=click.Path(path_type=Path, exists=True))
@click.argument("decoded", type=click.Path(path_type=Path, exists=True))
@click.option("-o", "--output", type=click.Path(path_type=Path), required=True)
@click.option("--size", default=320, show_default=True, help="Pixels of each picture.")
def main(original: Path, decoded: Path, output: Path, size: int) -> None:
    """Draw DECODED beside ORIGINAL."""
    sheet(read_asset(original), read_asset(decoded), size).save(output)


if __name__ == "__main__":
    main()
