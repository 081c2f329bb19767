"""Tiny documents with known answers, for tests: no training needed."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from io import BytesIO
from typing import Any

import numpy as np

from nispcodec.core.arrays import FloatArray, Uint8Array
from nispcodec.core.asset import Material, Texture, TextureMap
from nispcodec.core.document import ChartTable, Document, Field, Frame
from nispcodec.core.network import Network, NetworkSpec


def relu_network(layers: Sequence[tuple[FloatArray, FloatArray]], **options: Any) -> Network:
    """A ReLU network with the given (weight, bias) pairs."""
    hidden = tuple(len(bias) for _, bias in layers[:-1])
    spec = NetworkSpec(hidden, len(layers[-1][1]), activation="relu", **options)
    tensors = {}
    for index, (weight, bias) in enumerate(layers):
        tensors[f"weight.{index}"] = np.asarray(weight, np.float32)
        tensors[f"bias.{index}"] = np.asarray(bias, np.float32)
    return Network(spec, tensors)


def octahedron(size: float = 0.8) -> Network:
    """(|x| + |y| + |z| - size) / sqrt(3): the SDF of an octahedron, exact beside its faces."""
    axes = np.vstack([np.eye(3), -np.eye(3)])
    ones, third = np.full((1, 6), 1 / np.sqrt(3)), np.array([-size / np.sqrt(3)])
    return relu_network([(axes, np.zeros(6)), (ones, third)])


def sphere(radius: float = 0.6, width: int = 512, seed: int = 0) -> Network:
    """The SDF of a sphere, fitted by least squares on random sine features."""
    rng = np.random.default_rng(seed)
    spec = NetworkSpec((width,), 1, w0=3.0)
    weight = rng.normal(size=(width, 3)).astype(np.float32)
    bias = rng.uniform(-1, 1, width).astype(np.float32)
    points = rng.uniform(-1.05, 1.05, (8000, 3))
    # The cusp of the distance at the center would spoil the fit on the surface.
    points = points[np.linalg.norm(points, axis=1) > 0.3]
    features = np.column_stack([np.sin(3.0 * (points @ weight.T + bias)), np.ones(len(points))])
    wanted = np.linalg.norm(points, axis=1) - radius
    gram = features.T @ features + 1e-6 * np.eye(width + 1)
    solution = np.linalg.solve(gram, features.T @ wanted).astype(np.float32)
    tensors = {"weight.0": weight, "bias.0": bias}
    tensors |= {"weight.1": solution[None, :-1], "bias.1": solution[-1:]}
    return Network(spec, tensors)


def random_network(spec: NetworkSpec, seed: int = 0, scale: float = 0.3) -> Network:
    """Any topology with normal weights."""
    rng = np.random.default_rng(seed)
    shapes = spec.shapes.items()
    return Network(spec, {k: rng.normal(0, scale, s).astype(np.float32) for k, s in shapes})


def halves() -> Network:
    """Two charts: 0 where x < 0, 1 where x > 0."""
    sides = np.array([[-1.0, 0, 0], [1.0, 0, 0]])
    return relu_network([(sides, np.zeros(2)), (np.eye(2), np.zeros(2))])


def octants() -> Network:
    """Eight charts, one an octant: chart number = (x > 0) + 2 (y > 0) + 4 (z > 0)."""
    axes = np.vstack([-np.eye(3), np.eye(3)])
    signs = [[i >> axis & 1 for axis in range(3)] for i in range(8)]
    wanted = np.array([[1 - s for s in row] + row for row in signs])
    return relu_network([(axes, np.zeros(6)), (wanted, np.zeros(8))])


def plane_uv(charts: int) -> Network:
    """UV = (y, z) scaled into [0, 1]; u is shifted by half a unit a chart, so that seams show."""
    inputs = np.array([[0, 1.0, 0], [0, -1.0, 0], [0, 0, 1.0], [0, 0, -1.0]])
    embedding = np.vstack([np.zeros((4, 1)), np.ones((1, 1))])
    first = np.hstack([np.vstack([inputs, np.zeros((1, 3))]), embedding])
    last = np.array([[0.25, -0.25, 0, 0, 1.0], [0, 0, 0.25, -0.25, 0.0]])
    spec = NetworkSpec(
        (5,), 2, conditioning="chart_affine", charts=charts, embedding=1, activation="relu"
    )
    tensors = {
        "embedding": 0.5 * np.arange(charts)[:, None],
        "slopes": np.zeros((charts, 6)),
        "offsets": np.zeros((charts, 2)),
        "weight.0": first,
        "bias.0": np.zeros(5),
        "weight.1": last,
        "bias.1": np.full(2, 0.25),
    }
    return Network(spec, {name: tensor.astype(np.float32) for name, tensor in tensors.items()})


def png(pixels: Uint8Array, name: str = "tiny.png") -> Texture:
    """A texture with exactly these pixels, first row on top."""
    from PIL import Image

    data = BytesIO()
    Image.fromarray(pixels).save(data, "PNG")
    return Texture(name, data.getvalue(), "image/png")


def document(
    sdf: Network | None = None, chart: Network | None = None, frame: Frame | None = None
) -> Document:
    """An octahedron in two halves by default; texture red | green over blue | white."""
    chart = chart or halves()
    count = chart.spec.outputs
    pixels = np.array([[[255, 0, 0], [0, 255, 0]], [[0, 0, 255], [255, 255, 255]]], np.uint8)
    materials = (
        Material("painted", maps={"base_color": TextureMap(0)}),
        Material("plain", base_color=(0.5, 0.5, 0.5, 1.0)),
    )
    return Document(
        frame=frame or Frame((1.0, 2.0, 3.0), 2.0),
        materials=materials,
        textures=(png(pixels),),
        field=Field(
            charts=ChartTable(np.arange(count, dtype=np.int32) % 2, np.ones(count, np.bool_)),
            sdf=sdf or octahedron(),
            chart=chart,
            uv=plane_uv(count),
        ),
    )


def varied(document: Document, **changes: Any) -> Document:
    """The document with changes of its own members or of its field's."""
    own = {item.name for item in dataclasses.fields(Document)}
    field = field_of(document)
    inner = {name: value for name, value in changes.items() if name not in own}
    outer = {name: value for name, value in changes.items() if name in own}
    return dataclasses.replace(document, field=dataclasses.replace(field, **inner), **outer)


def field_of(document: Document) -> Field:
    """The document's field, which it has."""
    assert document.field
    return document.field
