"""`nisp render`: pictures of a `.nisp` file, sphere-traced."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from .files import output_option
from .progress import encode_progress

if TYPE_CHECKING:
    from collections.abc import Iterator

    from nispcodec.core.arrays import Float32Array
    from nispcodec.render.camera import Camera

CHANNELS = ("color", "normal", "uv", "chart", "depth", "sdf-steps")


@click.command("render", short_help="Draw a .nisp file.")
@click.argument("model", type=click.Path(path_type=Path))
@output_option(".png", ".webp", ".gif")
@click.option("--size", type=click.IntRange(16, 4096), default=512, show_default=True)
@click.option(
    "--view",
    default="30,20",
    show_default=True,
    help="front, back, left, right, top, bottom, or azimuth,elevation in degrees.",
)
@click.option(
    "--fov", type=click.FloatRange(1, 120), default=32, show_default=True, help="Degrees."
)
@click.option(
    "--turntable",
    type=click.IntRange(2, 1000),
    metavar="N",
    help="N views around: numbered PNGs, or one animated WebP or GIF.",
)
@click.option("--channel", type=click.Choice(CHANNELS), default="color", show_default=True)
@click.option("--no-normal-map", is_flag=True, help="Leave normal maps out, to compare.")
def command(
    model: Path,
    output: Path,
    size: int,
    view: str,
    fov: float,
    turntable: int | None,
    channel: str,
    no_normal_map: bool,
) -> None:
    """Draw MODEL (.nisp) by sphere tracing its distance field: no mesh is made.

    The background is transparent. sdf-steps shows how often the network was asked for each pixel.

    \b
    Example: nisp render model.nisp -o out.png --view 45,20
    """
    from nispcodec.core.atomic_write import write_atomic
    from nispcodec.render import camera
    from nispcodec.render.images import image_bytes

    first = camera.view(view, fov)
    cameras = [first]
    if turntable is not None:
        cameras = camera.turntable(turntable, first.elevation, fov, first.azimuth)
    numbered = turntable is not None and output.suffix.lower() == ".png"
    frames = []
    for number, picture in enumerate(pictures(model, cameras, size, channel, not no_normal_map)):
        if numbered:
            path = output.with_stem(f"{output.stem}-{number:03d}")
            write_atomic(path, image_bytes([picture], ".png"))
            click.echo(str(path))
        else:
            frames.append(picture)
    if frames:
        write_atomic(output, image_bytes(frames, output.suffix.lower()))
        click.echo(str(output))


def pictures(
    model: Path, cameras: list[Camera], size: int, channel: str, normal_map: bool
) -> Iterator[Float32Array]:
    """One picture a camera, with progress."""
    import nispcodec
    from nispcodec.core.progress import Progress
    from nispcodec.render.channels import channel_picture
    from nispcodec.render.maps import Maps
    from nispcodec.render.picture import Eye
    from nispcodec.render.views import scene_of

    scene = scene_of(nispcodec.load(model))
    maps = Maps(scene.textures)
    with encode_progress(quiet=len(cameras) == 1) as listener:
        for number, each in enumerate(cameras):
            listener(Progress(stage="rendering", step=number, steps=len(cameras)))
            yield channel_picture(Eye(scene, maps, each, size, normal_map), channel)
