"""The specification says what the code does: its tables, its hexdumps, its decoder."""

from __future__ import annotations

import random
from collections import defaultdict
from typing import Any

import numpy as np
import pytest

from nispcodec.core import asset, mesh_part, network, slots
from nispcodec.core.texture import sample_texture
from nispcodec.format import constants, inspect, pack, steps, unpack
from nispcodec.format.codings import frequency_model, registry
from nispcodec.format.codings.reader import Reader
from nispcodec.format.container import content, read_container
from nispcodec.format.record import Record
from nispcodec.infer.evaluate import evaluate
from tests.format import spec
from tests.format.documents import full
from tests.format.golden import slab
from tests.tiny import random_network

NAMES = (
    vars(network)
    | vars(asset)
    | vars(mesh_part)
    | vars(constants)
    | {"CODINGS": registry.CODINGS, "SLOTS": slots.SLOTS}
)
DECODER = spec.decoder()


@pytest.mark.parametrize(
    "name",
    [
        *("PRESETS", "NETWORKS", "CODINGS", "STEPS", "NUMBERS", "ENCODINGS", "CONDITIONINGS"),
        *(
            "ACTIVATIONS",
            "OUTPUTS",
            "ALPHA_MODES",
            "SLOTS",
            "WRAPS",
            "FILTERS",
            "MIME_TYPES",
            "MEASURES",
        ),
    ],
)
def test_enumerations(name: str) -> None:
    assert spec.enumeration(name) == NAMES[name]


def test_endings() -> None:
    rows = spec.table_after("Enumeration `MIME_TYPES`")
    assert tuple(row[2] for row in rows) == constants.ENDINGS


def test_caps() -> None:
    caps = {row[0].strip("`"): int(row[1]) for row in spec.table_after("## 9 Caps")}
    caps["MAX_MEMORY"] = constants.MAX_MEMORY
    assert f"`MAX_MEMORY` = {constants.MAX_MEMORY} bytes" in spec.TEXT
    assert caps == {name: value for name, value in NAMES.items() if name.startswith("MAX_")}


def test_sections_and_bits() -> None:
    rows = spec.table_after("Sections of this version")
    assert tuple(row[0] for row in rows) == constants.SECTIONS
    assert all(row[1] == "yes" for row in rows)
    assert "bit 0 (value 1): critical; bit 1 (value 2): packed" in spec.TEXT
    assert (constants.CRITICAL, constants.PACKED) == (1, 2)


def test_header_and_table_layout() -> None:
    header, entry = spec.table_after("Header:"), spec.table_after("Each row of the section table:")
    for rows, size in ((header, constants.HEADER_SIZE), (entry, constants.ENTRY_SIZE)):
        ends = [int(row[0]) + int(row[1]) for row in rows]
        assert [int(row[0]) for row in rows] == [0, *ends[:-1]]
        assert ends[-1] == size
    signature = bytes.fromhex(header[0][4].strip("`"))
    assert signature == constants.SIGNATURE
    assert int(header[1][4]) == constants.MAJOR


@pytest.mark.parametrize("cells", [1, 2, 90, 256])
@pytest.mark.parametrize("zeros", [0, 1, 255])
def test_its_frequencies(cells: int, zeros: int) -> None:
    for byte in range(128):
        made = frequency_model.FrequencyModel(byte & 31, byte >> 5, zeros)
        expected = DECODER["frequencies"](cells, made.narrowness, made.tail, zeros)
        assert np.diff(made.starts(cells)).tolist() == expected
        assert sum(expected) == 2**14
        assert min(expected) > 0


def test_its_steps() -> None:
    for byte in range(256):
        ours = steps.decode(Reader("NETS", bytes([byte])), "byte", None)
        assert DECODER["read_step"](DECODER["Reader"](bytes([byte])), 1, None) == ours


def test_fields_are_those_that_the_reader_asks_for(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = defaultdict(set)
    take = Record.take

    def noting(record: Record, key: int, name: str, kind: type[Any], default: Any = None) -> Any:
        asked[record.path].add((key, name))
        return take(record, key, name, kind, default)

    monkeypatch.setattr(Record, "take", noting)
    unpack(pack(full()))
    assert asked["document"] == spec.fields("document")
    assert asked["networks"] == spec.fields("networks")
    for name in ("sdf", "chart", "uv"):
        assert asked[f"networks.{name}"] == spec.fields("networks.sdf`, `networks.chart")
    assert asked["materials.0"] == spec.fields("materials")
    assert asked["materials.0.maps"] <= spec.fields("materials.maps")
    assert asked["materials.0.maps.normal"] == spec.fields("materials.maps.slot")
    assert asked["textures.0"] == spec.fields("textures")


def test_worked_example() -> None:
    assert pack(slab()) == spec.example()
    annotated = "".join(row[0].strip("`") for row in spec.table_after(spec.blocks("hexdump")[0]))
    assert bytes.fromhex(annotated) == spec.example()
    assert unpack(spec.example()).materials == slab().materials


def test_worked_example_of_the_entropy_coding() -> None:
    data = pack(slab(), "entropy")
    nets = next(entry for entry in read_container(data) if entry.code == "NETS")
    shown = bytes.fromhex("".join(spec.blocks("entropy")[0].split()))
    assert bytes(content(nets)) == shown
    annotated = "".join(row[0].strip("`") for row in spec.table_after(spec.blocks("entropy")[0]))
    assert bytes.fromhex(annotated) == shown


def test_its_container_reader() -> None:
    data = pack(full())
    for row, section in zip(DECODER["read_table"](data), inspect(data), strict=True):
        assert row[0] == section.code
        assert row[1] == section.critical
        assert row[2] == (section.packing == "zstd")
        assert len(row[3]) == section.stored_length
        assert row[4] == section.decoded_length


@pytest.mark.parametrize("coding", [None, *registry.CODINGS])
def test_its_weight_decoder(coding: str | None) -> None:
    document = full()
    data = pack(document, coding)
    nets = next(entry for entry in read_container(data) if entry.code == "NETS")
    tensors = [(matrices(each), each.spec.init_seed) for each in document.networks.values()]
    decoded = DECODER["read_nets"](bytes(content(nets)), tensors)
    for each, found in zip(document.networks.values(), decoded, strict=True):
        for values, tensor in zip(found, each.tensors.values(), strict=True):
            np.testing.assert_array_equal(np.array(values, np.float32), tensor.ravel())


def matrices(made: network.Network) -> list[tuple[int, int]]:
    """Rows and columns of every tensor; a bias is one row."""
    shapes = made.spec.shapes.values()
    return [(int(np.prod(shape[:-1])), shape[-1]) for shape in shapes]


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"encoding": "fourier", "levels": 3, "activation": "relu", "output": "tanh"},
        {"conditioning": "scalar", "charts": 5, "output": "sigmoid", "w0": 4.0},
        {"conditioning": "scalar", "charts": 5, "encoding": "fourier", "levels": 2},
        {
            "conditioning": "chart_affine",
            "charts": 5,
            "embedding": 3,
            "mirror": 18,
            "output": "sigmoid",
        },
        {"conditioning": "scalar", "charts": 5, "encoding": "fourier", "levels": 2, "mirror": 13},
    ],
    ids=["plain", "fourier", "scalar", "both", "chart_affine", "mirror"],
)
def test_its_evaluator(options: dict[str, Any]) -> None:
    made = random_network(network.NetworkSpec((8, 7), 2, **options), scale=0.1)
    points = np.random.default_rng(0).uniform(-1, 1, (20, 3)).astype(np.float32)
    charts = np.arange(20) % 5
    expected = evaluate(made, points, charts if made.spec.charts else None)
    tensors = [tensor.ravel().tolist() for tensor in made.tensors.values()]
    for point, chart, wanted in zip(points.tolist(), charts.tolist(), expected, strict=True):
        found = DECODER["evaluate"](vars(made.spec), 5, tensors, point, chart)
        assert found == pytest.approx(wanted.tolist(), abs=1e-4)


@pytest.mark.parametrize("filter", asset.FILTERS)
@pytest.mark.parametrize("wrap", asset.WRAPS)
def test_its_texture_lookup(wrap: str, filter: str) -> None:
    image = np.random.default_rng(0).random((3, 4, 4)).astype(np.float32)
    generator = random.Random(0)
    uvs = [(generator.uniform(-3, 3), generator.uniform(-3, 3)) for _ in range(40)]
    expected = sample_texture(image, np.array(uvs), (wrap, "repeat"), filter)
    for (u, v), wanted in zip(uvs, expected, strict=True):
        found = DECODER["look_up"](image.tolist(), u, v, wrap, "repeat", filter)
        assert found == pytest.approx(wanted.tolist(), abs=1e-5)
