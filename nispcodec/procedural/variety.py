"""Assets of many kinds, for a catalogue to try: shapes, materials, sizes, and broken ones."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
import PIL.Image

from nispcodec.core.arrays import Float64Array
from nispcodec.core.asset import Material, Texture, TexturedMesh, TextureMap

Random = np.random.Generator
Shape = Callable[[Random, Float64Array, Float64Array], Float64Array]
"""Random numbers, grids (r, c) of parameters in [0, 1] down and across -> positions (r, c, 3)."""


@dataclass(frozen=True)
class Sample:
    """An asset of a catalogue: path within it without a suffix, mesh, suffix of its file.

    broken: the name of what is to be done to the file once it is written, "" for nothing.
    """

    way: str
    mesh: TexturedMesh
    suffix: str
    broken: str = ""


@dataclass(frozen=True)
class VarietyConfig:
    """How assets vary.

    broken    every so manieth asset is broken
    rows      cells along a grid, least and most: 2 triangles each, columns as many again
    bodies    in an asset, at most
    texels    widths that images have
    textured  share of the materials that have an image
    suffixes  of the files: most assets that people have are OBJ or glTF
    folders   that assets are in; the names of files recur from one to the next
    """

    broken: int = 20
    rows: tuple[int, int] = (8, 48)
    bodies: int = 3
    texels: tuple[int, ...] = (64, 128, 256)
    textured: float = 0.75
    suffixes: tuple[str, ...] = (".obj", ".obj", ".glb", ".glb", ".ply")
    folders: tuple[str, ...] = ("garden", "kitchen", "street/night")


def torus(random: Random, down: Float64Array, across: Float64Array) -> Float64Array:
    """A ring."""
    thin = random.uniform(0.15, 0.45)
    u, v = _turn(across), _turn(down)
    ring = 1 + thin * np.cos(v)
    return np.stack([ring * np.cos(u), thin * np.sin(v), -ring * np.sin(u)], axis=2)


def vase(random: Random, down: Float64Array, across: Float64Array) -> Float64Array:
    """A closed body of revolution whose profile has a few waves."""
    waves = sum(random.normal() / k * np.sin(k * np.pi * down) for k in (1, 2, 3))
    radius = (0.3 + 0.3 * np.abs(waves)) * np.sqrt(_half_wave(down))
    u = _turn(across)
    return np.stack([radius * np.cos(u), 2 * down - 1, -radius * np.sin(u)], axis=2)


def pillow(random: Random, down: Float64Array, across: Float64Array) -> Float64Array:
    """A superellipsoid: from a ball to a box with round edges."""
    power = random.uniform(0.3, 1.0)

    def bent(values: Float64Array) -> Float64Array:
        found: Float64Array = np.sign(values) * np.abs(values) ** power
        return found

    u, v = _turn(across), np.pi * (down - 0.5)
    size = random.uniform(0.4, 1, 3)
    flat = bent(_half_wave(down))
    parts = [flat * bent(np.cos(u)), bent(np.sin(v)), -flat * bent(np.sin(u))]
    return size * np.stack(parts, axis=2)


def cloth(random: Random, down: Float64Array, across: Float64Array) -> Float64Array:
    """An open sheet with waves."""
    counts = random.integers(1, 5, 2)
    waves = np.sin(counts[0] * np.pi * across) * np.cos(counts[1] * np.pi * down)
    height = random.uniform(0.05, 0.3) * waves
    return np.stack([2 * across - 1, height, 1 - 2 * down], axis=2)


def _turn(share: Float64Array) -> Float64Array:
    """The angle for a share of a turn; that of a whole turn is 0 again, so that seams close."""
    angle: Float64Array = 2 * np.pi * (share % 1)
    return angle


def _half_wave(share: Float64Array) -> Float64Array:
    """From 0 up to 1 and down to 0, exactly, so that ends close."""
    wave: Float64Array = np.sin(np.pi * np.minimum(share, 1 - share))
    return wave


SHAPES: dict[str, Shape] = {"ring": torus, "vase": vase, "pillow": pillow, "cloth": cloth}
BREAKAGES = ("cut", "empty", "nonsense", "no-image", "no-faces")
"""What `broken` may be: all but a missing image are errors."""


def catalogue(count: int, seed: int, config: VarietyConfig = VarietyConfig()) -> Iterator[Sample]:
    """So many assets, the same ones for the same seed."""
    for number in range(count):
        yield _sample(number, np.random.default_rng([seed, number]), config)


def damaged(data: bytes, how: str) -> bytes:
    """The bytes of a mesh file after something went wrong; "no-image" is no matter of its bytes."""
    changed = {
        "cut": data[: len(data) // 5].rsplit(b" ", 1)[0],
        "empty": b"",
        "nonsense": bytes(range(256)),
        "no-faces": b"v 0 0 0\nv 1 0 0\nv 0 1 0\n",
    }
    return changed.get(how, data)


def _sample(number: int, random: Random, config: VarietyConfig) -> Sample:
    name = list(SHAPES)[random.integers(len(SHAPES))]
    folder = config.folders[number % len(config.folders)]
    way = f"{folder}/{name}-{number // len(config.folders):03d}"
    mesh = replace(_asset(random, SHAPES[name], config), name=name)
    suffix = config.suffixes[random.integers(len(config.suffixes))]
    if (number + 1) % config.broken:
        return Sample(way, mesh, suffix)
    how = BREAKAGES[number // config.broken % len(BREAKAGES)]
    return Sample(f"{way}-{how}", mesh, ".obj", how)


def _asset(random: Random, shape: Shape, config: VarietyConfig) -> TexturedMesh:
    """Bodies side by side, each with a chart or two, of a material of its own."""
    count = int(random.integers(1, config.bodies + 1))
    textures: list[Texture] = []
    materials, parts = [], []
    for number in range(count):
        maps = {}
        if random.random() < config.textured:
            maps["base_color"] = TextureMap(len(textures))
            textures.append(_image(random, f"image{number}.png", config))
        factor = (1.0, 1.0, 1.0) if maps else tuple(random.uniform(0.1, 1, 3))
        rough = float(random.uniform(0.1, 1))
        materials.append(Material(f"material{number}", (*factor, 1.0), 0.0, rough, maps=maps))
        parts.append(_body(random, shape, np.array([2.4 * number, 0, 0]), config))
    scale = float(10 ** random.uniform(-2, 2))
    return _joined(parts, scale, tuple(materials), tuple(textures))


def _body(
    random: Random, shape: Shape, place: Float64Array, config: VarietyConfig
) -> tuple[Float64Array, Float64Array]:
    """Positions (r, c, 3) and UVs (r, c, 2) of a grid."""
    rows = int(random.integers(config.rows[0], config.rows[1] + 1))
    down, across = np.meshgrid(
        np.linspace(0, 1, rows + 1), np.linspace(0, 1, 2 * rows + 1), indexing="ij"
    )
    edge = 0.02
    uvs = edge + (1 - 2 * edge) * np.stack([across, 1 - down], axis=2)
    return shape(random, down, across) + place, uvs


def _joined(
    parts: list[tuple[Float64Array, Float64Array]],
    scale: float,
    materials: tuple[Material, ...],
    textures: tuple[Texture, ...],
) -> TexturedMesh:
    faces, of_material, first = [], [], 0
    for number, (positions, _) in enumerate(parts):
        rows, columns = positions.shape[:2]
        grid = first + np.arange(rows * columns).reshape(rows, columns)
        a, b, c, d = grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]
        faces.append(np.stack([a, c, d, a, b, c], axis=-1).reshape(-1, 3))
        of_material.append(np.full(len(faces[-1]), number))
        first += rows * columns
    corners = np.concatenate(faces).astype(np.int32)
    return TexturedMesh(
        positions=scale * np.concatenate([each.reshape(-1, 3) for each, _ in parts]),
        faces=corners,
        uvs=np.concatenate([each.reshape(-1, 2) for _, each in parts]),
        uv_faces=corners,
        face_materials=np.concatenate(of_material).astype(np.int32),
        materials=materials,
        textures=textures,
    )


def _image(random: Random, name: str, config: VarietyConfig) -> Texture:
    """Checks, stripes or clouds in two colors."""
    size = config.texels[random.integers(len(config.texels))]
    y, x = np.mgrid[0:size, 0:size] / size
    count = int(random.integers(2, 9))
    patterns = (
        (np.floor(count * x) + np.floor(count * y)) % 2,
        0.5 + 0.5 * np.sin(2 * np.pi * count * (x + random.uniform(0, 0.2) * np.sin(9 * y))),
        0.5 + 0.5 * np.sin(2 * np.pi * x * count) * np.cos(2 * np.pi * y * count),
    )
    pattern = patterns[random.integers(len(patterns))][..., None]
    first, second = random.uniform(0, 1, (2, 3))
    pixels = np.round(255 * (first + (second - first) * pattern)).astype(np.uint8)
    file = io.BytesIO()
    PIL.Image.fromarray(pixels).save(file, "PNG")
    return Texture(name, file.getvalue(), "image/png")
