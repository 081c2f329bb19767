"""The documents of the conformance files: one for each coding and each feature."""

from __future__ import annotations

import dataclasses
import math
import struct
from collections.abc import Iterator
from io import BytesIO
from typing import Any

import numpy as np
from PIL import Image, ImageCms
from PIL.PngImagePlugin import PngInfo

from nispcodec.core.arrays import Uint8Array
from nispcodec.core.asset import WRAPS, Material, Texture, TextureMap
from nispcodec.core.document import ChartTable, Document, Field, Frame, StoredSection
from nispcodec.core.initial_weights import predicted
from nispcodec.core.network import Network, NetworkSpec
from nispcodec.core.slots import SLOTS
from nispcodec.format import mesh, metadata, pack
from nispcodec.format.codings import entropy
from nispcodec.format.codings.registry import BY_NAME
from nispcodec.format.records import Record, tensors
from nispcodec.infer.evaluate import evaluate
from tests.conformance import found_contents
from tests.conformance.builder import Row, container
from tests.conformance.malformed import meta, rows, squeezed
from tests.conformance.mesh_features import asset, box, mesh_features
from tests.tiny import field_of, varied

SYMBOL_STEP = 2.0**-9
ROW_STEP = 2.0**-14
ROWS_THEN_SAME = bytes.fromhex("29c880 03 04fd02 05fefd 2103 0301 2103 fb04 2103 fe")
"""Four dense tensors of integers: a step with row shifts, and three times the same step without."""


def network(hidden: tuple[int, ...], outputs: int, seed: int, **options: Any) -> Network:
    """Weights as a sine network has them after training: small but in the first layer."""
    spec = NetworkSpec(hidden, outputs, **options)
    generator = np.random.default_rng(seed)
    tensors = {
        name: generator.uniform(-limit, limit, spec.shapes[name]).astype(np.float32)
        for name, limit in limits(spec).items()
    }
    return Network(spec, tensors)


def limits(spec: NetworkSpec) -> dict[str, float]:
    """How large the weights of every tensor usually are at most."""
    sine = spec.activation == "sine"
    found = {}
    for name, shape in spec.shapes.items():
        inner = sine and not name.endswith((".0", f".{len(spec.hidden)}"))
        spread = spec.w0 if inner else 1.0
        found[name] = math.sqrt(6 / shape[-1]) / spread if name.startswith("weight") else 0.3
    return found


def rounded(source: Network) -> Network:
    """Weights that are float16."""
    tensors = {k: v.astype(np.float16).astype(np.float32) for k, v in source.tensors.items()}
    return Network(source.spec, tensors)


def pruned(source: Network) -> Network:
    """Two thirds of the weights zero, one whole row and one whole column of each matrix."""
    generator = np.random.default_rng(1)
    tensors = {}
    for name, tensor in source.tensors.items():
        kept = generator.random(tensor.shape) < 1 / 3
        if tensor.ndim == 2 and min(tensor.shape) > 1:
            kept[0], kept[:, -1] = False, False
        tensors[name] = tensor * kept
    return Network(source.spec, tensors)


def quantized(source: Network, step: float) -> Network:
    """Multiples of one step for weights and a finer one for biases."""
    steps = {name: step if "weight" in name else step / 8 for name in source.tensors}
    tensors = {
        name: np.rint(tensor / steps[name]).astype(np.float32) * np.float32(steps[name])
        for name, tensor in source.tensors.items()
    }
    return Network(source.spec, tensors, steps)


def moved(spec: NetworkSpec, step: float) -> Network:
    """Symbols a few steps from the initial weights, biases but not the last."""
    generator = np.random.default_rng(2)
    tensors, initial = {}, spec.initial_integers(spec.shapes)
    for name, limit in limits(spec).items():
        began = predicted(initial[name], round(limit / step), np.zeros(1, np.int64))
        lone = began.size == 1
        symbols = generator.normal(0, 60 if lone else 2, began.shape).round() + began * (not lone)
        tensors[name] = symbols.astype(np.float32) * np.float32(step)
    return Network(spec, tensors, dict.fromkeys(tensors, step))


def rows_apart(width: int) -> Network:
    """Symbols about initial weights, each row's with a row shift of its own, of so many bits."""
    source = moved(NetworkSpec((12, 11), 1), ROW_STEP)
    generator = np.random.default_rng(3)
    tensors = {}
    for name, tensor in source.tensors.items():
        grid = np.float32(ROW_STEP) * 2 ** generator.integers(0, 1 << width, (len(tensor), 1))
        matrix = tensor.reshape(len(tensor), -1)
        tensors[name] = (np.rint(matrix / grid) * grid).astype(np.float32).reshape(tensor.shape)
    return Network(source.spec, tensors, source.steps)


def pixels(width: int, height: int, seed: int = 0) -> Uint8Array:
    """A colorful RGBA image."""
    return np.random.default_rng(seed).integers(0, 256, (height, width, 4), dtype=np.uint8)


def texture(name: str, mime: str, image: Uint8Array, **options: Any) -> Texture:
    """The image as a file of this type."""
    buffer = BytesIO()
    Image.fromarray(image).save(buffer, mime.removeprefix("image/"), **options)
    return Texture(name, buffer.getvalue(), mime)


def plain() -> Document:
    """One chart without UV, one material, an SDF network."""
    return Document(
        frame=Frame((0.0, 0.0, 0.0), 1.0),
        materials=(Material(base_color=(0.5, 0.25, 0.125, 1.0)),),
        textures=(),
        field=Field(
            charts=ChartTable(np.zeros(1, np.int32), np.zeros(1, np.bool_)),
            sdf=network((12, 11), 1, 0),
        ),
    )


def textured(used: TextureMap | None = None, image: Texture | None = None) -> Document:
    """Two charts with UV, one material with a base color map."""
    material = Material("painted", maps={"base_color": used or TextureMap(0)})
    return varied(
        plain(),
        charts=ChartTable(np.zeros(2, np.int32), np.ones(2, np.bool_)),
        materials=(material,),
        textures=(image or texture("paint.png", "image/png", pixels(5, 4)),),
        chart=network((8,), 2, 1),
        uv=network((8, 8), 2, 2, conditioning="chart_affine", charts=2, embedding=3),
    )


def features() -> Iterator[tuple[str, bytes]]:
    """Name and bytes of every conformance file."""
    yield from _codings()
    yield from _topologies()
    yield from _tables()
    yield from _materials()
    yield from _shown_as_stored()
    yield from _not_finite()
    yield from _containers()
    yield from _messages()
    for name, made in mesh_features(textured().textures[0], textured()):
        yield name, pack(made)
    # More bytes of 0 than the faces want.
    yield "mesh-zeros-at-the-end", _beside_meta(mesh.encode((box(),)) + bytes(7))
    yield "mesh-far-gates", _beside_meta(found_contents.FAR)
    yield "mesh-crowded-points", _beside_meta(found_contents.CROWDED)


def _beside_meta(content: bytes) -> bytes:
    """A file with this content of MESH."""
    return container([Row(b"MESH", content), Row(b"META", metadata.encode(asset(box())))])


def _codings() -> Iterator[tuple[str, bytes]]:
    kinds = {
        "float32": field_of(plain()).sdf,
        "float16": rounded(field_of(plain()).sdf),
        "pruned": pruned(field_of(plain()).sdf),
        "symbols": quantized(field_of(plain()).sdf, 0.01),
        "pruned-symbols": quantized(pruned(field_of(plain()).sdf), 0.0078125),
        "wide-symbols": quantized(field_of(plain()).sdf, 1e-6),
    }
    for kind, sdf in kinds.items():
        for coding in (
            ("dense", "entropy")
            if "pruned" not in kind
            else ("coo", "csc", "csr", "dia", "entropy")
        ):
            document = varied(plain(), sdf=sdf)
            yield f"coding-{coding}-{kind}", pack(document, coding)
    for number in (0, 2**32 - 1):
        drawn = moved(NetworkSpec((12, 11), 1, init_seed=number), SYMBOL_STEP)
        yield f"coding-delta-init-{number}", pack(varied(plain(), sdf=drawn))
    for width in (1, 2, 3):
        yield f"row-shifts-{width}", pack(varied(plain(), sdf=rows_apart(width)))
    yield "row-shifts-then-same", container(rows(nets_bytes=ROWS_THEN_SAME))
    yield "wide-tag", _together(moved(NetworkSpec((6, 5, 4), 1), SYMBOL_STEP))
    coarse = varied(plain(), sdf=rows_apart(3))
    for coding in ("dense", "csc", "dia", "entropy"):
        yield f"row-shifts-{coding}", pack(coarse, coding)
    long = quantized(pruned(network((182, 182), 1, 12)), 2.0**-11)
    yield "coding-entropy-long", pack(varied(plain(), sdf=long), "entropy")
    shorter = quantized(network((100, 100), 1, 15), 2.0**-8)
    yield "coding-entropy-one-state", pack(varied(plain(), sdf=shorter), "entropy")
    yield from _wide_indices()
    yield "coding-entropy-256-cells", pack(_largest_of(256), "entropy")
    for coding in ("dense", "entropy"):
        yield f"coding-{coding}-subnormal", pack(_subnormal(), coding)
    first = field_of(plain()).sdf
    empty = Network(first.spec, {name: 0 * values for name, values in first.tensors.items()})
    for coding in ("coo", "csr", "dia", "entropy"):
        yield f"coding-{coding}-empty", pack(varied(plain(), sdf=empty), coding)


def _largest_of(limit: int) -> Document:
    """Symbols up to a limit, of either sign, in every tensor."""
    sdf = network((12, 11), 1, 0)
    steps = {name: float(np.abs(each).max()) / limit for name, each in sdf.tensors.items()}
    steps = {name: 2.0 ** math.floor(math.log2(step)) for name, step in steps.items()}
    tensors = {
        name: np.clip(np.rint(each / steps[name]), -limit, limit).astype("f4")
        * np.float32(steps[name])
        for name, each in sdf.tensors.items()
    }
    return varied(plain(), sdf=Network(sdf.spec, tensors, steps))


def _wide_indices() -> Iterator[tuple[str, bytes]]:
    """Matrices so large that places in them take two bytes, and four."""
    sparse = thinned(network((300, 2), 1, 16, activation="relu"), 0.05)
    for coding in ("coo", "csc", "csr", "dia"):
        document = varied(plain(), sdf=sparse)
        yield f"indices-of-two-bytes-{coding}", pack(document, coding)
    k = 65_535
    table = ChartTable(np.zeros(k, np.int32), np.zeros(k, np.bool_))
    spec = NetworkSpec((4,), k, activation="relu")
    tensors = {name: np.zeros(shape, np.float32) for name, shape in spec.shapes.items()}
    tensors["weight.0"][:3] = np.eye(3)
    tensors["bias.0"][3] = 1
    # On the diagonals of row - column = 65,531 and 32,767.
    tensors["weight.1"][[65_531, 65_532, 65_533, 65_534], range(4)] = 1, 2, 3, 0.25
    tensors["weight.1"][[32_767, 32_768], range(2)] = 1.5, 1.75
    many = varied(plain(), charts=table, chart=Network(spec, tensors))
    yield "indices-of-four-bytes", pack(many, "dia")


def thinned(source: Network, density: float) -> Network:
    """Weights of which a share is kept, biases whole."""
    generator = np.random.default_rng(4)
    tensors = {
        name: tensor * (generator.random(tensor.shape) < density) if tensor.ndim == 2 else tensor
        for name, tensor in rounded(source).tensors.items()
    }
    return Network(source.spec, tensors)


def _subnormal() -> Document:
    """First weights that float16 holds as subnormals alone, and last ones that make them count."""
    source = network((12,), 1, 17, activation="relu")
    factors = {"weight.0": 4e-5, "bias.0": 4e-5, "weight.1": 2e4}
    tensors = {
        name: each * np.float32(factors.get(name, 1)) for name, each in source.tensors.items()
    }
    return varied(plain(), sdf=rounded(Network(source.spec, tensors)))


def _together(sdf: Network) -> bytes:
    """All tensors in one record, more than a tag of one byte can say."""
    record = Record(BY_NAME["delta_init"], tensors("sdf", sdf), None, 0)
    assert record.run is not None
    data = record.encode() + entropy.encode([record.run])
    document = varied(plain(), sdf=sdf)
    return container(rows(metadata.encode(document), data))


def _topologies() -> Iterator[tuple[str, bytes]]:
    fourier = {"encoding": "fourier", "levels": 5, "activation": "relu"}
    sdfs = {
        "paper": network((16, 16), 1, 3, output="tanh", **fourier),
        "relu": network((16,), 1, 4, activation="relu"),
        "w0": network((16, 8), 1, 5, w0=12.5),
        "sigmoid": network((16,), 1, 6, output="sigmoid"),
        "deep": network((6,) * 8, 1, 7),
        "mirror": network((9, 8), 1, 13, mirror=0b101),
        "signed-axes": network((9, 8), 1, 14, mirror=0b011011),
    }
    for name, sdf in sdfs.items():
        yield f"topology-{name}", pack(varied(plain(), sdf=sdf))
    uvs: dict[str, dict[str, Any]] = {
        "none": {},
        "scalar": {"conditioning": "scalar", "charts": 2},
        "scalar-fourier": {"conditioning": "scalar", "charts": 2, **fourier, "output": "sigmoid"},
        "scalar-mirror": {"conditioning": "scalar", "charts": 2, **fourier, "mirror": 0b010},
        "scalar-signed-axes": {
            "conditioning": "scalar",
            "charts": 2,
            **fourier,
            "mirror": 0b010010,
        },
        "chart-affine": {"conditioning": "chart_affine", "charts": 2, "embedding": 4},
        "chart-affine-signed-axes": {
            "conditioning": "chart_affine",
            "charts": 2,
            "embedding": 1,
            "mirror": 0b001011,
            "output": "sigmoid",
        },
    }
    for name, options in uvs.items():
        document = varied(textured(), uv=network((10, 9), 2, 8, **options))
        yield f"conditioning-{name}", pack(document)


def _tables() -> Iterator[tuple[str, bytes]]:
    base = textured()
    frame = Frame((1e6 + 1 / 3, -2000.125, 0.1), 1234.5678)
    yield "frame-far-away", pack(dataclasses.replace(base, frame=frame))
    table = dataclasses.replace(field_of(base).charts, uv_offset=(-1.5, 0.1), uv_scale=(3.0, 0.7))
    yield "uv-map", pack(varied(base, charts=table))
    table = ChartTable(np.array([0, 1, 0, 1, 1], np.int32), np.array([1, 0, 1, 1, 0], np.bool_))
    uv = network((8,), 2, 9, conditioning="scalar", charts=5)
    materials = (base.materials[0], Material("glass", (0.1, 0.5, 0.9, 0.25), alpha_mode="blend"))
    five = varied(base, charts=table, materials=materials, chart=network((9,), 5, 10), uv=uv)
    yield "charts-five", pack(five)
    kinds = tuple(Material(f"m{i}", (i / 256, 1 - i / 256, 0.5, 1.0)) for i in range(257))
    many = ChartTable(np.arange(257, dtype=np.int32)[::-1].copy(), np.zeros(257, np.bool_))
    wide = rounded(network((4,), 257, 11))
    yield (
        "charts-many",
        pack(varied(plain(), charts=many, materials=kinds, chart=wide)),
    )
    pair = field_of(base).networks["chart"]
    tie = {name: tensor[[0, 0]] if name in ("weight.1", "bias.1") else tensor
           for name, tensor in pair.tensors.items()}  # fmt: skip
    yield "charts-tie", pack(varied(base, chart=Network(pair.spec, tie)))
    yield "half-thickness", pack(varied(plain(), half_thickness=0.015625))
    flags = np.array([1, 0], np.bool_)
    opened = dataclasses.replace(field_of(base).charts, has_uv=flags, openings=True)
    yield "openings", pack(varied(base, charts=opened))
    often = balanced(pair)
    yield "openings-win", pack(varied(base, charts=opened, chart=often))
    bare = dataclasses.replace(
        field_of(base).charts, has_uv=flags, uv_offset=(0.3, -0.7), uv_scale=(2.0, 3.0)
    )
    tinted = Material("tinted", (0.75, 0.5, 0.25, 1.0), maps={"base_color": TextureMap(0)})
    yield (
        "chart-without-uv",
        pack(varied(base, charts=bare, chart=often, materials=(tinted,))),
    )


def balanced(chart: Network) -> Network:
    """A chart network of two outputs, each the larger at half of all points."""
    points = np.random.default_rng(5).uniform(-0.8, 0.8, (999, 3)).astype(np.float32)
    first, second = evaluate(chart, points).T
    bias = chart.tensors["bias.1"] + np.array([np.median(second - first), 0], np.float32)
    return Network(chart.spec, {**chart.tensors, "bias.1": bias.astype(np.float16).astype("f4")})


def _materials() -> Iterator[tuple[str, bytes]]:
    stretched = ChartTable(np.zeros(2, np.int32), np.ones(2, np.bool_), (-3.0, -3.0), (7.0, 7.0))
    for u, v in zip(WRAPS, WRAPS[1:] + WRAPS[:1], strict=True):
        document = textured(TextureMap(0, (u, v)))
        yield f"wrap-{u}-{v}", pack(varied(document, charts=stretched))
    yield "filter-nearest", pack(textured(TextureMap(0, filter="nearest")))
    opaque = pixels(8, 8)[..., :3]
    full = {"quality": 90, "subsampling": "4:4:4"}
    yield "image-jpeg", pack(textured(image=texture("a.jpeg", "image/jpeg", opaque, **full)))
    webp = texture("a.webp", "image/webp", pixels(8, 8), lossless=True)
    yield "image-webp", pack(textured(image=webp))
    avif = texture("a.avif", "image/avif", opaque, **full)
    yield "image-avif", pack(textured(image=avif))
    gray = texture("gray.png", "image/png", pixels(6, 3)[..., 0])
    yield "image-gray", pack(textured(image=gray))
    tinted = Material("tinted", (0.8, 0.5, 0.2, 0.5), maps={"base_color": TextureMap(0)})
    yield "factor", pack(dataclasses.replace(textured(), materials=(tinted,)))
    bright = Material("bright", (1.75, 3.0, 0.5, 1.5), maps={"base_color": TextureMap(0)})
    yield "factor-clipped", pack(dataclasses.replace(textured(), materials=(bright,)))
    dark = Material("beyond", (1.5, -0.25, 0.5, 2.0))
    yield "factor-clipped-alone", pack(dataclasses.replace(plain(), materials=(dark,)))
    maps = {
        slot: TextureMap(i % 2, ("clamp", "mirror"), "nearest", 0.5) for i, slot in enumerate(SLOTS)
    }
    rich = Material(
        "rich – ünïcödé",
        (1.0, 1.0, 1.0, 1.0),
        0.75,
        0.25,
        (0.5, 0.25, 2.0),
        "mask",
        0.125,
        True,
        maps,
    )
    named = ("wood.v2.png", ".png", "a.b", "...", "größe \u202f.PNG")
    several = tuple(
        texture(name, "image/png", pixels(2, 2, place)) for place, name in enumerate(named)
    )
    yield "texture-names", pack(dataclasses.replace(textured(), textures=several))
    images = (textured().textures[0], texture("other one.png", "image/png", pixels(2, 2)))
    yield "material-full", pack(dataclasses.replace(textured(), materials=(rich,), textures=images))


def _shown_as_stored() -> Iterator[tuple[str, bytes]]:
    """Images that say how they are to be turned, and in which colors: readers ignore it."""
    opaque, full = pixels(8, 6)[..., :3], dict[str, Any](quality=95, subsampling="4:4:4")
    turned, mirrored = Image.Exif(), Image.Exif()
    turned[0x0112], mirrored[0x0112] = 6, 5
    sayings: dict[str, dict[str, Any]] = {
        "turned": {"exif": turned},
        "mirrored": {"exif": mirrored},
        "profile": {"icc_profile": swapping_profile()},
    }
    kinds: dict[str, dict[str, Any]] = {
        "png": {}, "jpeg": full, "webp": {"lossless": True}, "avif": full,
    }  # fmt: skip
    for kind, options in kinds.items():
        name = f"a.{kind.replace('jpeg', 'jpg')}"
        for what, said in sayings.items():
            image = texture(name, f"image/{kind}", opaque, **options, **said)
            yield f"image-{kind}-{what}", pack(textured(image=image))
    chunks = PngInfo()
    chunks.add(b"gAMA", struct.pack(">I", 100_000))
    linear = texture("a.png", "image/png", opaque, pnginfo=chunks)
    yield "image-png-gamma", pack(textured(image=linear))
    deep = Image.fromarray(np.arange(0, 48_000, 1_000, dtype=np.uint16).reshape(6, 8))
    buffer = BytesIO()
    deep.save(buffer, "png")
    gray = Texture("deep.png", buffer.getvalue(), "image/png")
    yield "image-gray-16-bits", pack(textured(image=gray))
    palette = Image.fromarray(opaque).quantize(16)
    buffer = BytesIO()
    palette.save(buffer, "png")
    few = Texture("palette.png", buffer.getvalue(), "image/png")
    yield "image-palette", pack(textured(image=few))
    striped = np.where(np.arange(8)[:, None] % 3 > 0, opaque[0, 0], opaque)
    color = tuple(striped[0, 1].tolist())
    clear = texture("clear.png", "image/png", striped, transparency=color)
    yield "image-png-clear-rgb", pack(textured(image=clear))
    clear = texture("clear.png", "image/png", striped[..., 0], transparency=color[0])
    yield "image-png-clear-gray", pack(textured(image=clear))


def swapping_profile() -> bytes:
    """sRGB with the primaries of red and blue exchanged: a picture shown by it looks different."""
    profile = bytearray(ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes())
    count = struct.unpack_from(">I", profile, 128)[0]
    places = {bytes(profile[at : at + 4]): at for at in range(132, 132 + 12 * count, 12)}
    red, blue = places[b"rXYZ"], places[b"bXYZ"]
    profile[red : red + 4], profile[blue : blue + 4] = b"bXYZ", b"rXYZ"
    profile[24:36] = struct.pack(">6H", 2026, 1, 1, 0, 0, 0)  # else the time of day
    return bytes(profile)


def _not_finite() -> Iterator[tuple[str, bytes]]:
    """Answers beyond every float, in float64 too, and what follows from them."""
    large = np.float32(3e38)
    hidden = (1,) * 9
    for name, last in {"nan": ((2, -2), (1, -1)), "infinite": ((1, 1), (-1, -1))}.items():
        spec = NetworkSpec((*hidden, 2), 2, activation="relu")
        tensors = {
            n: np.full(shape, large * ("weight" in n), "f4") for n, shape in spec.shapes.items()
        }
        tensors["bias.0"][:] = large
        tensors["weight.0"][:] = 1
        tensors["weight.10"] = np.array(last, np.float32)
        odd = Network(spec, tensors)
        yield f"uv-{name}", pack(varied(textured(), uv=odd))
    yield "logits-nan", pack(varied(_three(), chart=_one_nan(odd)))


def _three() -> Document:
    """Three charts in colors of their own, without UV."""
    colors = ((1.0, 0.0, 0.0, 1.0), (0.0, 1.0, 0.0, 1.0), (0.0, 0.0, 1.0, 1.0))
    table = ChartTable(np.arange(3, dtype=np.int32), np.zeros(3, np.bool_))
    materials = tuple(Material(base_color=color) for color in colors)
    return varied(plain(), charts=table, materials=materials, chart=network((4,), 3, 1))


def _one_nan(source: Network) -> Network:
    """A network whose outputs are always 1, 2 and NaN."""
    spec = dataclasses.replace(source.spec, outputs=3)
    last = {
        "weight.10": np.array([[0, 0], [0, 0], [1, -1]], np.float32),
        "bias.10": np.array([1, 2, 0], "f4"),
    }
    return Network(spec, {**source.tensors, **last})


def _messages() -> Iterator[tuple[str, bytes]]:
    """Every form that a value of META may take."""
    edges = [0, 127, 128, 255, 256, 65_535, 65_536, 2**32 - 1, 2**32, 2**64 - 1]
    below = [-1, -32, -33, -128, -129, -32_768, -32_769, -(2**31), -(2**31) - 1, -(2**63)]
    numbers = {f"n{place}": number for place, number in enumerate(edges + below)}
    yield "messagepack-integers", pack(dataclasses.replace(plain(), info=numbers))
    texts = {
        f"t{length}": "é" * (length // 2) + "x" * (length % 2)
        for length in (0, 31, 32, 255, 256, 1024)
    }
    texts["﻿mark"] = "﻿text after a byte order mark"
    kinds: dict[str, str | int | float | bool] = {
        **texts,
        "yes": True,
        "no": False,
        "tenth": 0.1,
        "large": 1e300,
    }
    marked = (Material("﻿marked ", (0.5, 0.25, 0.125, 1.0)),)
    yield "messagepack-texts", pack(dataclasses.replace(plain(), info=kinds, materials=marked))
    negative = dataclasses.replace(plain(), frame=Frame((-0.0, 0.0, -0.0), 1.0))
    yield "negative-zero", pack(negative)


def _containers() -> Iterator[tuple[str, bytes]]:
    info: dict[str, str | int | float | bool] = {
        "tool": "conformance", "seed": -1, "large": 2**64 - 1, "error": 4e-4, "ok": True,
        "hidden_share": 0.0129, "uv_error_mean": 3.34e-6,
    }  # fmt: skip
    yield "info", pack(dataclasses.replace(plain(), info=info))
    text = b"kept, whatever it is " * 20
    extra = {"AAAA": StoredSection(b""), "ZZ99": StoredSection(squeezed(text), len(text))}
    noise = StoredSection(b"no frame of Zstandard", 2**20)
    yield "unknown-ancillary-noise", pack(dataclasses.replace(plain(), extra={"ZSTD": noise}))
    yield "unknown-ancillary", pack(dataclasses.replace(plain(), extra=extra))
    yield "textures-two-alike", pack(dataclasses.replace(textured(), textures=_twins()))
    for minor in (9, 255):
        yield f"minor-version-{minor}", container(rows(), minor=minor)
    described = meta({10: {"note": "again " * 60}})
    asking = Row(b"META", _with_widest_window(squeezed(described)), 3, decoded=len(described))
    yield "zstd-window", container([asking, *rows()[1:]])


def _with_widest_window(frame: bytes) -> bytes:
    """A zstd frame of 256 bytes to 64 kB that asks for the widest window that readers accept."""
    assert frame[4] == 0x60
    return frame[:4] + b"\x40\xa8" + frame[5:]


def _twins() -> tuple[Texture, Texture]:
    image = texture("twin.png", "image/png", pixels(2, 2))
    return image, image
