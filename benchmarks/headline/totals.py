"""Whole assets with their images, at equal rendered PSNR: ours against simplify + Draco, gltfpack.

    nisp encode ASSET -o DIR/NAME.nisp --target-total SIZE
    python -m benchmarks.headline.totals --models DIR --assets ../shared/assets [--only spot]

Beside Draco are the same images as in our file: padded, AVIF, the same shares. Beside gltfpack are
the same padded images as WebP, or as KTX2 (`benchmarks/codecs/ktx2.py`). Of every rival's settings
and images those of the fewest bytes count whose pictures are as good as ours, which are of the mesh
that the written bytes decode to: eight sides, the same renderer. Draco is counted without a
container. None has normals: creases are found by angle in all of them, the original too.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import takewhile
from math import inf
from pathlib import Path

import click

import nispcodec
from benchmarks.assets.source import Source
from benchmarks.codecs import (
    Setting,
    codec,
    gltfpack,
    ktx2,
    simplified_draco,
    simplified_gltfpack,
)
from benchmarks.measuring.model_records import measured, models_options
from benchmarks.measuring.result_file import Record
from benchmarks.measuring.target import Asked, Target, asked_of_each
from nispcodec.core.asset import Texture, TexturedMesh
from nispcodec.core.texture import encoded_texture
from nispcodec.encode.compact_images import CompactImage, compact_images
from nispcodec.encode.image_shares import ImageShares
from nispcodec.encode.total import Pictures
from nispcodec.encode.total_config import TotalConfig
from nispcodec.metrics.psnr import psnr
from nispcodec.render.remembered import RememberedScene
from nispcodec.render.views import scene_of

RESULTS = Path("benchmarks/results/totals.json")
KEPT = (0.5, 0.25, 0.125, 0.0625)
BITS, WHOLE_BITS = (10, 11), (9, 10, 11, 12, 13, 14, 16, 18)
"""Of positions and UVs of simplified meshes, and of all faces."""
FEWEST = 150
# The weight of UVs that is best as a rule, and seams as they are.
MOVING: Setting = {"uv_weight": 10.0, "seams": "protected"}
# AVIF's bytes are tried in steps this large.
STEP = 1.03
# From the best down, as long as pictures lose little enough.
WEBP = (98, 92, 85, 75, 60, 45, 30, 15, 1)
UASTC, ETC1S = (50,), (100, 80, 60, 40, 20, 1)
LEAST_TAKEN = 0.9
# A mesh that loses so many times too much at a glance, on a few small pictures, is not looked at:
# outlines, where most is lost when little is, are four times as much of these.
GLANCE, HOPELESS = replace(TotalConfig(), views=2, size=128), 30.0
TARGET = Target("share of Draco's total", ("draco", "share"), 0.9)


@dataclass(frozen=True)
class Geometry:
    """A rival's mesh: its bytes, its scene, and what pictures of it with all of the images lose."""

    codec: str
    setting: Setting
    bytes: int
    scene: RememberedScene
    error: float


@dataclass(frozen=True)
class Coded:
    """Images of an asset as some codec has them: a name, their bytes, what pictures lose by them.

    Both are expected, the error on the original's surface; `made` gives the bytes that are taken,
    LEAST_TAKEN of those expected or more, and the textures.
    """

    name: str
    bytes: int
    error: float
    made: Callable[[], tuple[int, tuple[Texture, ...]]]


@dataclass(frozen=True)
class Rivals:
    """One asset, the squared error that rivals are to have, and our bytes."""

    asset: Source
    pictures: Pictures
    wanted: float
    total: int

    @cached_property
    def images(self) -> list[CompactImage]:
        return compact_images(self.asset.mesh)

    def draco(self) -> Record:
        """With AVIF."""
        grid = list(_settings(self.asset))
        moving = [{**each, **MOVING} for each in grid if each["kept"] != 1.0]
        ways = [("simplified_draco", each) for each in grid]
        ways += [("simplified_update_draco", each) for each in moving]
        return self.fewest(self.geometries(ways), self.avif())

    def gltfpack(self, images: Iterable[Coded]) -> Record:
        """With images of some other codec."""
        return self.fewest(self._packed, images)

    @cached_property
    def _packed(self) -> list[Geometry]:
        ways = [("gltfpack", each) for each in gltfpack.settings(self.asset, False)]
        ways += [("simplified_gltfpack", e) for e in simplified_gltfpack.settings(self.asset, True)]
        return self.geometries(way for way in ways if way[1]["compression"] == "cz")

    def geometries(self, ways: Iterable[tuple[str, Setting]]) -> list[Geometry]:
        """Those that alone leave no more error than there may be."""
        found = [self.geometry(*way) for way in ways]
        return [each for each in found if each and each.error < self.wanted]

    def geometry(self, name: str, setting: Setting) -> Geometry | None:
        """A rival's mesh, unless it is hopeless."""
        coder = codec(name)
        data = coder.encode(self.asset, setting)
        scene = _scene(coder.decode(data, self.asset), self.pictures)
        if self._glance.error(scene) > HOPELESS * self.wanted:
            return None
        return Geometry(name, setting, len(data), scene, self.pictures.error(scene))

    @cached_property
    def _glance(self) -> Pictures:
        return _pictures(self.asset, GLANCE)

    def fewest(self, geometries: list[Geometry], images: Iterable[Coded]) -> Record:
        """The fewest bytes at which pictures lose no more than is wanted."""
        coded, best = list(images), inf
        found: Record = {"bytes": None}
        pairs = [(g, i) for g in geometries for i in coded if g.error + i.error <= self.wanted]
        for geometry, image in sorted(pairs, key=lambda pair: pair[0].bytes + pair[1].bytes):
            if geometry.bytes + LEAST_TAKEN * image.bytes >= best:
                continue
            size, textures = image.made()
            error = self.pictures.error(geometry.scene.with_textures(textures))
            if error <= self.wanted and geometry.bytes + size < best:
                best = geometry.bytes + size
                found = {
                    "codec": geometry.codec,
                    "setting": geometry.setting,
                    "images": image.name,
                    "geometry": geometry.bytes,
                    "bytes": best,
                    "psnr": psnr(error, 1.0),
                    "share": self.total / best,
                }
        return found

    def avif(self) -> Iterator[Coded]:
        """As in our file: the same sizes of colors and data for a sum of bytes."""
        shares, most = ImageShares(self.images), 4.0 * self.total
        shares.measure(TotalConfig().qualities, most, self.pictures.error_of_textures)
        size = float(shares.least)
        while size < most:
            yield Coded("avif", round(size), shares.error(size), partial(_fitted, shares, size))
            size *= STEP

    def webp(self) -> Iterator[Coded]:
        """At a quality for all of them."""
        return self._good_enough(self._webp(quality) for quality in WEBP)

    def ktx2(self) -> Iterator[Coded]:
        """As UASTC, and at a quality of ETC1S for all of them."""
        yield from self._good_enough(self._ktx2("uastc", quality) for quality in UASTC)
        yield from self._good_enough(self._ktx2("etc1s", quality) for quality in ETC1S)

    def _good_enough(self, coded: Iterable[Coded]) -> Iterator[Coded]:
        return takewhile(lambda each: each.error < self.wanted, coded)

    def _webp(self, quality: int) -> Coded:
        found = tuple(
            encoded_texture(each.original.name, each.padded_pixels(), "webp", quality, False)
            for each in self.images
        )
        return self._coded(f"webp {quality}", sum(len(each.data) for each in found), found)

    def _ktx2(self, blocks: str, quality: int) -> Coded:
        files, found = [], []
        for each in self.images:
            name = each.original.name
            plain = encoded_texture(name, each.padded_pixels(), "png", 100, True)
            files.append(ktx2.encode(plain, blocks, quality, each.is_data))
            found.append(ktx2.decode(files[-1], name))
        return self._coded(f"{blocks} {quality}", sum(map(len, files)), tuple(found))

    def _coded(self, name: str, size: int, textures: tuple[Texture, ...]) -> Coded:
        error = self.pictures.error_of_textures(textures)
        return Coded(name, size, error, lambda: (size, textures))


def asked(results: Record) -> Iterator[Asked]:
    """The targets of every asset in a result file."""
    return asked_of_each(results["assets"], lambda _: [TARGET])


def measure(path: Path, source: Path) -> Record:
    """Our file, and the fewest bytes of each rival at its PSNR; None where it reaches none such."""
    asset, model = Source(source), nispcodec.load(path)
    pictures = _pictures(asset, TotalConfig())
    error = pictures.error(_scene(model.to_mesh(), pictures))
    images = sum(len(each.data) for each in model.document.textures)
    total = path.stat().st_size
    rivals = Rivals(asset, pictures, error, total)
    return {
        "preset": model.document.info["preset"],
        "bytes": total,
        "held_as": "networks" if model.document.field else "triangles",
        "geometry_share": (total - images) / total,
        "psnr": psnr(error, 1.0),
        "draco": rivals.draco(),
        "gltfpack_webp": rivals.gltfpack(rivals.webp()),
        "gltfpack_ktx2": rivals.gltfpack(rivals.ktx2()),
    }


def _settings(asset: Source) -> Iterator[Setting]:
    """Of Draco: all faces, and fewer."""
    surfaces = ("all", "outer") if asset.hidden_share > simplified_draco.NOTABLE else ("all",)
    shares = [kept for kept in KEPT if kept * len(asset.mesh.faces) > FEWEST]
    sizes = [(1.0, bits) for bits in WHOLE_BITS]
    sizes += [(kept, bits) for kept in shares for bits in BITS]
    for surface in surfaces:
        for kept, bits in sizes:
            yield {"surface": surface, "kept": kept, "qp": bits, "qt": bits}


def _fitted(shares: ImageShares, size: float) -> tuple[int, tuple[Texture, ...]]:
    textures = shares.fitted(size)
    return sum(len(each.data) for each in textures), textures


def _pictures(asset: Source, tuning: TotalConfig) -> Pictures:
    return Pictures(replace(asset.mesh, creases=None), tuning)


def _scene(mesh: TexturedMesh, pictures: Pictures) -> RememberedScene:
    return RememberedScene(scene_of(replace(mesh, creases=None), pictures.frame))


@click.command()
@models_options(RESULTS)
def main(models: Path, assets: Path, only: tuple[str, ...], output: Path) -> None:
    """Measure every NAME.nisp in MODELS and print our share of each rival's bytes."""
    records = measured(models, assets, only, output, measure)
    for name, record in records.items():
        click.echo(f"{name:<24}{record['bytes']:>9,} B {record['psnr']:.2f} dB")
        for rival in ("draco", "gltfpack_webp", "gltfpack_ktx2"):
            click.echo(f"    {rival:<20}{record[rival]}")
    for each in asked({"assets": records}):
        click.echo(each.line())


if __name__ == "__main__":
    main()
