"""`nisp render`: pictures of a `.nisp` file, sphere-traced."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .choices import LibraryChoice, channels, picture_suffixes, views
from .outputs import OutputFile, listed, output_option, refuse_overwriting
from .progress import progress_options, shown
from .ranges import Real, Whole
from .report import print_json, print_written
from .sources import Source, model_argument, parsed
from .subcommand import force_option, json_option, subcommand

if TYPE_CHECKING:
    from nispcodec.core.arrays import Float32Array
    from nispcodec.core.document import Document
    from nispcodec.core.progress import Listener
    from nispcodec.render.camera import Camera


class View(LibraryChoice):
    """A view that has a name, or azimuth and elevation."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """As it was written. Raises BadParameter, with the names, for no view at all."""
        from nispcodec.core.errors import QueryError
        from nispcodec.render.camera import view

        try:
            view(value)
        except QueryError as why:
            self.fail(str(why).removeprefix("view: "), param, ctx)
        return value

    def get_metavar(self, param: click.Parameter, ctx: click.Context) -> str:
        """`[front|back|AZIMUTH,ELEVATION]`, for the help."""
        return f"[{'|'.join(self.choices)}|AZIMUTH,ELEVATION]"


@subcommand("render", "Draw a .nisp file.")
@model_argument
@output_option(OutputFile(picture_suffixes))
@click.option("--size", type=Whole(16, 4096), default=512, show_default=True)
@click.option(
    "--view", type=View(views), default="30,20", show_default=True, help="Angles in degrees."
)
@click.option("--fov", type=Real(1, 120), default=32, show_default=True, help="Degrees.")
@click.option(
    "--turntable",
    type=Whole(2, 1000),
    metavar="N",
    help="N views around: numbered PNGs, or one animated WebP or GIF.",
)
@click.option("--channel", type=LibraryChoice(channels), default="color", show_default=True)
@click.option("--no-normal-map", is_flag=True, help="Leave normal maps out, to compare.")
@force_option
@progress_options
@json_option
def command(
    model: Source,
    output: Path,
    view: str,
    fov: float,
    turntable: int | None,
    force: bool,
    progress: str,
    quiet: bool,
    as_json: bool,
    **how: Any,
) -> None:
    """Draw MODEL (.nisp, or - for standard input) by sphere tracing: no mesh is made.

    The background is transparent. sdf-steps shows how often the network was asked for each pixel.

    \b
    Example: nisp render model.nisp -o out.png --view 45,20
    """
    started = time.monotonic()
    paths = _planned(output, turntable)
    refuse_overwriting(paths, force)
    document = parsed(model.read(), model)
    with shown("render", progress, quiet) as listen:
        drawn = pictures(document, _cameras(view, fov, turntable), listen, **how)
        _write(drawn, paths)
    if as_json:
        print_json({"files": listed(paths), "seconds": round(time.monotonic() - started, 1)})
    else:
        print_written(paths)


def _planned(output: Path, turntable: int | None) -> list[Path]:
    """One file, or one for each view of a turntable."""
    if turntable is None or output.suffix.lower() != ".png":
        return [output]
    return [output.with_stem(f"{output.stem}-{number:03d}") for number in range(turntable)]


def _cameras(view: str, fov: float, turntable: int | None) -> list[Camera]:
    from nispcodec.render import camera

    first = camera.view(view, fov)
    if turntable is None:
        return [first]
    return camera.turntable(turntable, first.elevation, fov, first.azimuth)


def pictures(
    document: Document,
    cameras: Sequence[Camera],
    listen: Listener,
    size: int,
    channel: str,
    no_normal_map: bool,
) -> Iterator[Float32Array]:
    """One picture a camera, with progress."""
    from nispcodec.core.progress import Progress
    from nispcodec.model import NispModel
    from nispcodec.render.channels import channel_picture
    from nispcodec.render.maps import Maps
    from nispcodec.render.picture import Eye
    from nispcodec.render.views import scene_of

    scene = scene_of(NispModel(document))
    maps = Maps(scene.textures)
    for number, each in enumerate(cameras):
        listen(Progress(stage="view", step=number, steps=len(cameras)))
        yield channel_picture(Eye(scene, maps, each, size, not no_normal_map), channel)


def _write(drawn: Iterator[Float32Array], paths: list[Path]) -> None:
    """Each picture to its file, or all to one."""
    from nispcodec.core.atomic_write import write_atomic
    from nispcodec.render.images import image_bytes

    if len(paths) == 1:
        write_atomic(paths[0], image_bytes(list(drawn), paths[0].suffix.lower()))
        return
    for path, picture in zip(paths, drawn, strict=True):
        write_atomic(path, image_bytes([picture], ".png"))
