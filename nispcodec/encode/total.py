"""A whole asset, images included, in so many bytes, shared so that pictures lose least."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from nispcodec.core.arrays import Float32Array
from nispcodec.core.asset import Texture, TexturedMesh
from nispcodec.core.document import ChartTable, Document, Field, Frame
from nispcodec.core.errors import NispError, TargetSizeError
from nispcodec.core.extras import require
from nispcodec.core.network import NetworkSpec
from nispcodec.core.progress import Listener, Progress, silent
from nispcodec.encode.choice import Loss
from nispcodec.encode.compact_images import compact_images
from nispcodec.encode.config import EncodeConfig
from nispcodec.encode.image_shares import ImageShares
from nispcodec.encode.targets import blank_network
from nispcodec.encode.total_config import TotalConfig
from nispcodec.format import own_bytes, pack
from nispcodec.metrics.psnr import psnr
from nispcodec.model import NispModel
from nispcodec.render.camera import turntable
from nispcodec.render.remembered import RememberedScene
from nispcodec.render.views import on_white, render_views, scene_of

Geometry = Callable[[EncodeConfig, Listener, Loss | None], NispModel]


def encode_to_total(
    mesh: TexturedMesh,
    config: EncodeConfig,
    tuning: TotalConfig,
    geometry: Geometry,
    progress: Listener,
) -> NispModel:
    """The asset in `config.target_total` bytes at most; `geometry` encodes it without textures.

    Pictures decide, with images in the bytes that are left: which triangles are best, and whether
    networks are better. Where these are, their size is what the preset has, or another whose
    pictures are expected to lose clearly less and do. Raises NispError, before anything is fitted,
    for a total that is less than images at the lowest quality and the smallest geometry take.
    """
    if not mesh.textures:
        how = replace(config, target_total=None, target_size=config.target_total)
        return geometry(how, progress, None)
    require("embreex", "igl", extra="render", what_for="a target total")
    progress(Progress(stage="textures", overall=0.0))
    shares = ImageShares(compact_images(mesh))
    total = float(config.target_total or 0)
    fixed = shares.least + _names_of_images(mesh, shares) + tuning.measured_bytes
    if total - fixed < tuning.scarce:
        _expect_possible(config, total - fixed, geometry)
    pictures = Pictures(mesh, tuning)
    shares.measure(tuning.qualities, total, pictures.error_of_textures)
    totals = _Totals(mesh, config, tuning, geometry, shares, pictures, total, total - fixed)
    splits = totals.splits(progress)
    progress(Progress(stage="textures", overall=tuning.done[-1]))
    return min(map(totals.whole, splits), key=lambda each: each[1])[0]


class Pictures:
    """Pictures of an original from all around, on white, and how far others are from them."""

    def __init__(self, mesh: TexturedMesh, tuning: TotalConfig) -> None:
        self._views, self._size = turntable(tuning.views), tuning.size
        self._scene = RememberedScene(scene_of(mesh))
        self.frame = self._scene.frame
        self._pictures = self._drawn(self._scene)

    def error_of_textures(self, textures: tuple[Texture, ...]) -> float:
        """Mean squared error of pictures of the original with other images."""
        return self.error(self._scene.with_textures(textures))

    def error(self, scene: RememberedScene) -> float:
        """Mean squared error of pictures of a scene, over RGB values in [0, 1]."""
        pairs = zip(self._pictures, self._drawn(scene), strict=True)
        return float(np.mean([np.square(first - second).mean() for first, second in pairs]))

    def _drawn(self, scene: RememberedScene) -> list[Float32Array]:
        return [on_white(each) for each in render_views(scene, self._views, self._size)]


@dataclass(frozen=True)
class Split:
    """A geometry with the images as they came: its bytes, what pictures lose, and its surface."""

    document: Document
    bytes: int
    error: float
    scene: RememberedScene


@dataclass(frozen=True)
class _Totals:
    """One asset and everything that a split of its bytes depends on.

    `room` is what a geometry may take, undressed.
    """

    mesh: TexturedMesh
    config: EncodeConfig
    tuning: TotalConfig
    geometry: Geometry
    shares: ImageShares
    pictures: Pictures
    total: float
    room: float

    def splits(self, progress: Listener) -> list[Split]:
        """The split of the preset's geometry, and one that is expected to be better, if any."""
        first = self.split(0.0, _within(progress, *self.tuning.done[:2]))
        size = self.better_size(first)
        if not size:
            return [first]
        networks = replace(self, config=replace(self.config, geometry="field"))
        try:
            return [first, networks.split(size, _within(progress, *self.tuning.done[1:]))]
        except NispError as why:
            progress(Progress(stage="fit", note=str(why), overall=self.tuning.done[-1]))
            return [first]

    def split(self, size: float, progress: Listener) -> Split:
        """A geometry of `size` bytes; 0: as the preset has it, or as large as there is room."""
        found = self._document(size, progress)
        if not size and own_bytes(pack(found)) > self.room:
            found = self._document(self.room, progress)
        found = self._dressed(found)
        progress(Progress(stage="surface", overall=1.0))
        scene = self._scene(found)
        return Split(found, self._own(found), self.pictures.error(scene), scene)

    def loss(self, document: Document) -> float:
        """About the squared error of pictures of a geometry with images in the bytes it leaves."""
        dressed = self._dressed(document)
        images = self.shares.error(self.total - self._own(dressed))
        return images + self.pictures.error(self._scene(dressed)) if images < math.inf else math.inf

    def better_size(self, found: Split) -> float:
        """Bytes of networks that are expected to be clearly better than those of a split, or 0."""
        if not found.document.field or found.document.meshes:
            return 0.0
        tuning, slope = self.tuning, self.tuning.field_slope
        now = found.error + self.shares.error(self.total - found.bytes)
        expected = {
            found.bytes * 2**octave: found.error * 2 ** (-slope * octave)
            + self.shares.error(self.total - found.bytes * 2**octave)
            for octave in tuning.octaves
        }
        size = min(expected, key=lambda each: expected[each])
        return size if expected[size] < tuning.worth_a_fit * now else 0.0

    def whole(self, split: Split) -> tuple[NispModel, float]:
        """The split with images in the bytes that it leaves, and what pictures of it lose."""
        room, over = self.total - split.bytes, float(self.tuning.measured_bytes)
        while over > 0:
            room -= over
            textures = self.shares.fitted(room)
            error = self.pictures.error(split.scene.with_textures(textures))
            info = {**split.document.info, "rendered_psnr": float(f"{psnr(error, 1.0):.4g}")}
            document = replace(split.document, textures=textures, info=info)
            over = len(pack(document)) - self.total if room > self.shares.least else 0.0
        return NispModel(document), error

    def _document(self, size: float, progress: Listener) -> Document:
        try:
            return self.geometry(_of_size(self.config, size), progress, self.loss).document
        except TargetSizeError as refused:
            raise _too_small(self.total, self.room, refused) from refused

    def _dressed(self, document: Document) -> Document:
        return replace(document, materials=self.mesh.materials, textures=self.mesh.textures)

    def _scene(self, document: Document) -> RememberedScene:
        return RememberedScene(scene_of(NispModel(document).to_mesh(), self.pictures.frame))

    def _own(self, document: Document) -> int:
        """Bytes besides those of the images, with their names."""
        return len(pack(replace(document, textures=self.shares.smallest))) - self.shares.least


def _of_size(config: EncodeConfig, size: float) -> EncodeConfig:
    """How the geometry alone is encoded; 0: of any size."""
    return replace(config, target_total=None, target_size=size or None, textures=False)


def _names_of_images(mesh: TexturedMesh, shares: ImageShares) -> int:
    """Bytes that images add to a file besides their own."""
    bare = tuple(replace(material, maps={}) for material in mesh.materials)
    charts = ChartTable(np.zeros(1, np.int32), np.zeros(1, np.bool_))
    field = Field(charts, blank_network(NetworkSpec((1,), 1)))
    undressed = Document(Frame((0.0, 0.0, 0.0), 1.0), bare, (), field)
    dressed = replace(undressed, materials=mesh.materials, textures=shares.smallest)
    return own_bytes(pack(dressed)) - own_bytes(pack(undressed))


def _expect_possible(config: EncodeConfig, room: float, geometry: Geometry) -> None:
    """Raises NispError for a total that leaves less room than the smallest geometry takes."""
    try:
        geometry(_of_size(config, 1.0), silent, None)
    except TargetSizeError as refused:
        if refused.least > room:
            raise _too_small(float(config.target_total or 0), room, refused) from refused


def _too_small(total: float, room: float, refused: TargetSizeError) -> NispError:
    images = math.ceil(total - room)
    return NispError(
        f"target total: expected at least {images + refused.least:,} bytes for this asset, "
        f"{images:,} of them for images at the lowest quality, found {total:,.0f}"
    )


def _within(listen: Listener, start: float, end: float) -> Listener:
    """A listener to a part of the work, which tells how far the whole is."""

    def heard(update: Progress) -> None:
        listen(replace(update, overall=start + (end - start) * update.overall))

    return heard
