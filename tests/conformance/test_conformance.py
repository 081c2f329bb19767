"""The committed files decode to the committed answers, by the library and by the specification."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nispcodec.decode.model import NispModel
from nispcodec.errors import FormatError
from nispcodec.format import pack, unpack
from nispcodec.format.constants import CODINGS
from nispcodec.format.container import content, read_container
from nispcodec.texture import decode_image
from tests.format import spec
from tests.format.documents import assert_same

HERE = Path(__file__).parent
FILES = sorted(HERE.glob("*.nisp"))
MALFORMED = json.loads((HERE / "malformed" / "expected.json").read_text())
TOLERANCE = json.loads((HERE / "tolerance.json").read_text())
DECODER = spec.decoder()

each_file = pytest.mark.parametrize("path", FILES, ids=[path.stem for path in FILES])


def expected(path: Path) -> dict[str, Any]:
    """The answers beside a file, as arrays."""
    answers = json.loads(path.with_suffix(".json").read_text())
    return {name: np.array(value) for name, value in answers.items()}


def close(found: Any, wanted: Any, kind: str, scale: Any = 1.0) -> bool:
    """Within the tolerance for this kind of answer."""
    return bool((np.abs(np.asarray(found) - wanted) <= TOLERANCE[kind] * np.asarray(scale)).all())


@each_file
def test_the_library_answers(path: Path) -> None:
    document = unpack(path.read_bytes())
    model, wanted = NispModel(document), expected(path)
    points = wanted["points"]
    assert close(model.sdf(points, "normalised"), wanted["sdf"], "sdf")
    assert (model.charts(points, "normalised") == wanted["chart"]).all()
    uvs = model.uv(points, "normalised")
    assert close(uvs, wanted["uv"], "uv", np.maximum(np.abs(document.charts.uv_scale), 1))
    assert close(model.color(points, "normalised"), wanted["color"], "color")
    if "world_points" in wanted:
        found = model.sdf(wanted["world_points"])
        assert close(found, wanted["world_sdf"], "sdf", document.frame.radius)


@each_file
def test_the_specification_answers(path: Path) -> None:
    document, wanted = unpack(path.read_bytes()), expected(path)
    weights = spec_weights(path)
    table, k = document.charts, len(document.charts)

    def ask(name: str, point: Any, chart: int = 0) -> list[float]:
        made = vars(document.networks[name].spec)
        answer: list[float] = DECODER["evaluate"](made, k, weights[name], point, chart)
        return answer

    for row, point in enumerate(wanted["points"].tolist()):
        assert close(ask("sdf", point)[0], wanted["sdf"][row], "sdf")
        logits = ask("chart", point) if k > 1 else [0.0]
        chart = logits.index(max(logits))
        assert chart == wanted["chart"][row]
        if table.has_uv[chart]:
            placed = np.array(ask("uv", point, chart)) * table.uv_scale + table.uv_offset
            assert close(placed, wanted["uv"][row], "uv", np.maximum(np.abs(table.uv_scale), 1))
        else:
            assert (wanted["uv"][row] == 0).all()


def spec_weights(path: Path) -> dict[str, list[list[float]]]:
    """The tensors of every network, by the specification's decoder."""
    data = path.read_bytes()
    nets = next(entry for entry in read_container(data) if entry.code == "NETS")
    networks = unpack(data).networks
    shapes = [
        [(1, *shape)[-2:] for shape in each.spec.shapes.values()] for each in networks.values()
    ]
    return dict(zip(networks, DECODER["read_nets"](bytes(content(nets)), shapes), strict=True))


@each_file
def test_the_specification_looks_colours_up(path: Path) -> None:
    document, wanted = unpack(path.read_bytes()), expected(path)
    images = [decode_image(texture).tolist() for texture in document.textures]
    for row, chart in enumerate(wanted["chart"].tolist()):
        material = document.materials[document.charts.materials[chart]]
        used = material.maps.get("base_color")
        texels = None
        if used is not None and document.charts.has_uv[chart]:
            image, place = images[used.texture], wanted["uv"][row]
            texels = DECODER["look_up"](image, *place, *used.wrap, used.filter)
        found = DECODER["color"](list(material.base_color), texels)
        assert close(found, wanted["color"][row], "color")


@each_file
def test_they_are_rewritten_without_loss(path: Path) -> None:
    document = unpack(path.read_bytes())
    for coding in (None, *CODINGS):
        assert_same(unpack(pack(document, coding)), document)


@pytest.mark.parametrize("name", MALFORMED)
def test_malformed_files_are_refused(name: str) -> None:
    with pytest.raises(FormatError) as caught:
        unpack((HERE / "malformed" / f"{name}.nisp").read_bytes())
    assert caught.value.section == MALFORMED[name]["section"]
    assert caught.value.field == MALFORMED[name]["field"]


def test_the_set_is_complete_and_small() -> None:
    stems = {path.stem for path in FILES}
    assert stems == {path.stem for path in HERE.glob("*.json")} - {"tolerance"}
    assert {path.stem for path in (HERE / "malformed").glob("*.nisp")} == set(MALFORMED)
    for coding in CODINGS:
        assert any(stem.startswith(f"coding-{coding}-") for stem in stems)
    files = [*HERE.rglob("*.nisp"), *HERE.rglob("*.json")]
    assert sum(path.stat().st_size for path in files) < 300_000
