"""Documents for tests: tiny ones by hand, arbitrary ones by hypothesis."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from hypothesis import strategies as st

from nispcodec.core.asset import (
    ALPHA_MODES,
    FILTERS,
    MIME_TYPES,
    WRAPS,
    Material,
    Texture,
    TextureMap,
)
from nispcodec.core.document import ChartTable, Document, Field, Frame, StoredSection
from nispcodec.core.mesh_part import MeshPart
from nispcodec.core.network import ACTIVATIONS, CONDITIONINGS, OUTPUTS, Network, NetworkSpec
from nispcodec.core.slots import SLOTS
from nispcodec.format.constants import SECTIONS
from tests.format.mesh.parts import faces_of


def network(spec: NetworkSpec, seed: int = 0, scale: float = 1.0) -> Network:
    """Normal weights, exactly representable as float16."""
    generator = np.random.default_rng(seed)
    return Network(
        spec,
        {
            name: (generator.normal(size=shape) * scale).astype(np.float16).astype(np.float32)
            for name, shape in spec.shapes.items()
        },
    )


def quantized(source: Network, step: float = 0.125, density: float = 1.0, seed: int = 0) -> Network:
    """The network rounded to multiples of `step`, a share of its weights zero."""
    generator = np.random.default_rng(seed)
    symbols = {
        name: np.rint(tensor / step) * (generator.random(tensor.shape) < density)
        for name, tensor in source.tensors.items()
    }
    tensors = {
        name: values.astype(np.float32) * np.float32(step) for name, values in symbols.items()
    }
    return Network(source.spec, tensors, dict.fromkeys(tensors, step))


def tiny() -> Document:
    """One chart, no UV, no texture: the smallest valid document."""
    return Document(
        frame=Frame((0.0, 0.0, 0.0), 1.0),
        materials=(Material(),),
        textures=(),
        field=Field(
            charts=ChartTable(np.zeros(1, np.int32), np.zeros(1, np.bool_)),
            sdf=network(NetworkSpec((2,), 1)),
        ),
    )


def full() -> Document:
    """Three charts, all networks, two materials, a texture, an unknown section."""
    charts = ChartTable(
        np.array([0, 1, 0], np.int32), np.array([True, True, False]), (-0.5, 0.25), (2.0, 1.5), True
    )
    wood = TextureMap(0, ("clamp", "mirror"), "nearest", 0.5)
    return Document(
        frame=Frame((0.1, 2.0, -3.0), 4.5),
        materials=(
            Material("wood", maps={"base_color": wood, "normal": TextureMap(1)}),
            Material("glass", (0.5, 0.5, 1.0, 0.25), alpha_mode="blend", double_sided=True),
        ),
        textures=(
            Texture("wood.png", b"not really a png", "image/png"),
            Texture("wood normal.jpg", b"nor a jpeg", "image/jpeg"),
        ),
        field=Field(
            charts=charts,
            sdf=quantized(network(NetworkSpec((4, 3), 1, activation="relu", output="tanh"))),
            chart=network(NetworkSpec((5,), 3, encoding="fourier", levels=2), 1),
            uv=network(NetworkSpec((4,), 2, conditioning="chart_affine", charts=3, embedding=2), 2),
            half_thickness=0.01,
        ),
        info={"tool": "test", "seed": 7, "seconds": 0.1, "ok": True, "preset": "best"},
        extra={"ZZZZ": StoredSection(b"from the future")},
    )


_NUMBERS = st.floats(-1e6, 1e6, width=32)
_NAMES = st.text(st.characters(exclude_categories=["Cc", "Cs"]), max_size=12)
_FILES = st.from_regex(r"[a-z][a-z0-9 ]{0,8}\.(png|jpg)", fullmatch=True)
_UNIT = st.floats(0, 1)
_IMAGES = st.binary(min_size=1, max_size=40)
_STORED = st.one_of(
    st.builds(StoredSection, st.binary(max_size=40)),
    st.builds(StoredSection, st.binary(max_size=40), st.integers(41, 2**20)),
)


def maps(textures: int) -> st.SearchStrategy[dict[str, TextureMap]]:
    """Slots to uses of existing textures."""
    if textures == 0:
        return st.just({})
    wraps = st.sampled_from(WRAPS)
    use = st.builds(
        TextureMap,
        st.integers(0, textures - 1),
        st.tuples(wraps, wraps),
        st.sampled_from(FILTERS),
        _UNIT,
    )
    return st.dictionaries(st.sampled_from(SLOTS), use)


def materials(textures: int) -> st.SearchStrategy[Material]:
    """Any material."""
    return st.builds(
        Material,
        _NAMES,
        st.tuples(_UNIT, _UNIT, _UNIT, _UNIT),
        _UNIT,
        _UNIT,
        st.tuples(_UNIT, _UNIT, _UNIT),
        st.sampled_from(ALPHA_MODES),
        _UNIT,
        st.booleans(),
        maps(textures),
    )


@st.composite
def networks(draw: st.DrawFn, outputs: int, charts: int = 0) -> Network:
    """A network of any kind; `charts` 0: not conditioned. Pruned, quantized or neither."""
    conditioning = draw(st.sampled_from(CONDITIONINGS)) if charts else "none"
    fourier = draw(st.booleans())
    spec = NetworkSpec(
        hidden=tuple(draw(st.lists(st.integers(1, 6), min_size=1, max_size=3))),
        outputs=outputs,
        encoding="fourier" if fourier else "identity",
        levels=draw(st.integers(1, 3)) if fourier else 0,
        conditioning=conditioning,
        charts=charts if conditioning != "none" else 0,
        embedding=draw(st.integers(1, 3)) if conditioning == "chart_affine" else 0,
        activation=draw(st.sampled_from(ACTIVATIONS)),
        w0=draw(st.floats(0.5, 60)),
        output=draw(st.sampled_from(OUTPUTS)),
        mirror=draw(st.sampled_from([*range(8), 0b001001, 0b110111])),
        init_seed=draw(st.sampled_from([0, 1, 2**32 - 1])),
    )
    made = network(spec, draw(st.integers(0, 9)), draw(st.sampled_from([1e-6, 0.1, 50.0])))
    if draw(st.booleans()):
        step = draw(st.sampled_from([0.125, 0.1, 1e-3]))
        return quantized(made, step, draw(st.sampled_from([0.0, 0.2, 1.0])))
    return made


@st.composite
def documents(draw: st.DrawFn) -> Document:
    """Any valid document."""
    count = draw(st.integers(1, 9))
    kinds = draw(st.integers(1, 3))
    names = draw(st.lists(_FILES, max_size=3))
    table = ChartTable(
        np.array(draw(st.lists(st.integers(0, kinds - 1), min_size=count, max_size=count)), "i4"),
        np.array(draw(st.lists(st.booleans(), min_size=count, max_size=count)), np.bool_),
        draw(st.tuples(_NUMBERS, _NUMBERS)),
        draw(st.tuples(_NUMBERS, _NUMBERS)),
    )
    if count > 1 and not table.has_uv[-1]:
        table = replace(table, openings=draw(st.booleans()))
    codes = st.from_regex(r"[A-Z0-9]{4}", fullmatch=True)
    unknown = codes.filter(lambda code: code not in SECTIONS)
    scalars = st.one_of(st.integers(-(2**63), 2**64 - 1), _NUMBERS, _NAMES, st.booleans())
    return Document(
        frame=Frame(draw(st.tuples(_NUMBERS, _NUMBERS, _NUMBERS)), draw(st.floats(1e-6, 1e6))),
        materials=tuple(draw(materials(len(names))) for _ in range(kinds)),
        textures=tuple(
            Texture(
                name, draw(st.binary(min_size=1, max_size=40)), draw(st.sampled_from(MIME_TYPES))
            )
            for name in names
        ),
        field=Field(
            charts=table,
            sdf=draw(networks(1)),
            chart=draw(networks(count)) if count > 1 else None,
            uv=draw(networks(2, count)) if table.has_uv.any() else None,
            half_thickness=draw(_UNIT),
        ),
        info=draw(st.dictionaries(_NAMES, scalars, max_size=4)),
        extra=draw(st.dictionaries(unknown, _STORED, max_size=2)),
    )


def assert_same(first: Document, second: Document) -> None:
    """Equal in everything, weights exactly."""
    assert first.frame == second.frame
    if first.field or second.field:
        _assert_same_tables(first.field, second.field)
    _assert_same_meshes(first.meshes, second.meshes)
    assert first.materials == second.materials
    assert first.textures == second.textures
    assert first.extra == second.extra
    assert first.info.keys() == second.info.keys()
    for key, value in first.info.items():
        assert value == second.info[key] or np.float32(value) == np.float32(second.info[key])
    assert first.networks.keys() == second.networks.keys()
    for name, network_ in first.networks.items():
        other = second.networks[name]
        assert network_.spec == other.spec
        assert network_.steps.keys() == other.steps.keys()
        for key, tensor in network_.tensors.items():
            np.testing.assert_array_equal(tensor, other.tensors[key])
            assert np.float32(network_.steps.get(key, 0)) == np.float32(other.steps.get(key, 0))


def _assert_same_meshes(first: tuple[MeshPart, ...], second: tuple[MeshPart, ...]) -> None:
    for one, other in zip(first, second, strict=True):
        assert faces_of(one) == faces_of(other)
        assert (one.step, one.origin) == (other.step, other.origin)
        assert (one.uv_step, one.uv_origin) == (other.uv_step, other.uv_origin)
        for place, again in zip(one.placements, other.placements, strict=True):
            assert replace(place, materials=None) == replace(again, materials=None)
            assert (place.materials is None) == (again.materials is None)


def _assert_same_tables(first: Field | None, second: Field | None) -> None:
    assert first
    assert second
    assert (first.charts.materials == second.charts.materials).all()
    assert (first.charts.has_uv == second.charts.has_uv).all()
    assert first.charts.uv_offset == second.charts.uv_offset
    assert first.charts.uv_scale == second.charts.uv_scale
    assert first.charts.openings == second.charts.openings
    assert first.half_thickness == second.half_thickness
