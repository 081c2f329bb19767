"""The committed files decode to the committed answers: by the library, and by the specification."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nispcodec.core.errors import FormatError
from nispcodec.format import pack, unpack
from nispcodec.format.codings.registry import CODINGS
from nispcodec.model import NispModel
from tests.conformance.independent import Reader
from tests.format.documents import assert_same
from tests.tiny import field_of

HERE = Path(__file__).parent
FILES = sorted(HERE.glob("*.nisp"))
MALFORMED = json.loads((HERE / "malformed" / "expected.json").read_text())
TOLERANCE = json.loads((HERE / "tolerance.json").read_text())

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
    assert close(model.sdf(points, "normalized"), wanted["sdf"], "sdf")
    assert (model.charts(points, "normalized") == wanted["chart"]).all()
    uvs = model.uv(points, "normalized")
    assert close(uvs, wanted["uv"], "uv", np.maximum(np.abs(field_of(document).charts.uv_scale), 1))
    assert close(model.color(points, "normalized"), wanted["color"], "color")
    if "world_points" in wanted:
        found = model.sdf(wanted["world_points"])
        assert close(found, wanted["world_sdf"], "sdf", document.frame.radius)


@each_file
def test_the_specification_answers(path: Path) -> None:
    reader, wanted = Reader(path.read_bytes()), expected(path)
    scale = np.maximum(np.abs(reader.uv_map[2:]), 1)
    for row, point in enumerate(wanted["points"].tolist()):
        chart = reader.chart(point)
        assert chart == wanted["chart"][row]
        assert close(reader.ask(1, point)[0], wanted["sdf"][row], "sdf")
        assert close(reader.uv(point, chart), wanted["uv"][row], "uv", scale)
        assert close(reader.color(point), wanted["color"][row], "color")


@each_file
def test_world_points(path: Path) -> None:
    *center, radius = Reader(path.read_bytes()).frame
    wanted = expected(path)
    world = wanted["points"] * radius + center
    assert close(world, wanted.get("world_points", world), "sdf", radius)


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
        assert any(stem.startswith(f"coding-{coding.replace(chr(95), chr(45))}-") for stem in stems)
    files = [*HERE.rglob("*.nisp"), *HERE.rglob("*.json")]
    assert sum(path.stat().st_size for path in files) < 300_000
