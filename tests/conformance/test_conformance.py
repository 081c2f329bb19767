"""The committed files decode to the committed answers: by the library, and by the specification."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nispcodec.core.document import Document
from nispcodec.core.errors import FormatError
from nispcodec.format import pack, unpack
from nispcodec.format.codings.registry import CODINGS
from nispcodec.model import NispModel
from tests.conformance.described import by_the_library, described
from tests.conformance.independent import Reader
from tests.format.documents import assert_same

HERE = Path(__file__).parent
FILES = sorted(HERE.glob("*.nisp"))
MALFORMED = json.loads((HERE / "malformed" / "expected.json").read_text())
TOLERANCE = json.loads((HERE / "tolerance.json").read_text())

each_file = pytest.mark.parametrize("path", FILES, ids=[path.stem for path in FILES])


def expected(path: Path) -> dict[str, Any]:
    """The answers beside a file, as arrays."""
    answers = json.loads(path.with_suffix(".json").read_text())
    kinds = {"chart": np.int64, "other_chart": np.int64, "document": object}
    return {name: np.array(v, kinds.get(name, np.float64)) for name, v in answers.items()}


def close(found: Any, wanted: Any, kind: str, scale: Any = 1.0) -> bool:
    """Within the tolerance for this kind of answer; NaN and infinities are the same ones."""
    tolerance = TOLERANCE[kind] * np.broadcast_to(scale, np.shape(wanted))
    found, wanted = np.asarray(found, np.float64), np.asarray(wanted)
    odd = ~np.isfinite(wanted)
    same = np.array_equal(found[odd], wanted[odd], equal_nan=True)
    return same and bool((np.abs(found[~odd] - wanted[~odd]) <= tolerance[~odd]).all())


@each_file
def test_the_library_answers(path: Path) -> None:
    check_the_library(path)


def check_the_library(path: Path) -> None:
    """The library's answers about a file are those beside it."""
    document = unpack(path.read_bytes())
    model, wanted = NispModel(document), expected(path)
    points = wanted["points"]
    kind = "sdf" if document.field else "mesh_sdf"
    assert close(model.sdf(points, "normalized"), wanted["sdf"], kind)
    assert close(model.normals(points, "normalized"), wanted["normal"], "normal")
    assert (model.charts(points, "normalized") == wanted["chart"]).all()
    uvs = model.uv(points, "normalized")
    assert close(uvs, wanted["uv"], "uv", uv_scale(document))
    if "other_chart" in wanted:
        others = model.uv(points, "normalized", wanted["other_chart"])
        assert close(others, wanted["other_uv"], "uv")
    assert close(model.color(points, "normalized"), wanted["color"], "color")
    assert by_the_library(document) == wanted["document"]
    if "world_points" in wanted:
        found = model.sdf(wanted["world_points"])
        assert close(found, wanted["world_sdf"], "sdf", document.frame.radius)


def uv_scale(document: Document) -> Any:
    """By how much the UV of the network is stretched."""
    return np.maximum(np.abs(document.field.charts.uv_scale), 1) if document.field else 1.0


@each_file
def test_the_specification_answers(path: Path) -> None:
    reader, wanted = Reader(path.read_bytes()), expected(path)
    assert described(reader) == wanted["document"]
    scale = np.maximum(np.abs(reader.meta["uv_map"][2:]), 1)
    for row, point in enumerate(wanted["points"].tolist()):
        chart = reader.chart(point)
        assert chart == wanted["chart"][row]
        kind = "sdf" if reader.specs else "mesh_sdf"
        assert close(reader.distance(point), wanted["sdf"][row], kind)
        assert close(reader.normal(point), wanted["normal"][row], "normal")
        if "other_chart" in wanted:
            found = reader.uv(point, wanted["other_chart"][row])
            assert close(found, wanted["other_uv"][row], "uv")
        assert close(reader.uv(point, chart), wanted["uv"][row], "uv", scale)
        assert close(reader.color(point), wanted["color"][row], "color")


@each_file
def test_world_points(path: Path) -> None:
    *center, radius = Reader(path.read_bytes()).meta["frame"]
    wanted = expected(path)
    world = wanted["points"] * radius + center
    assert close(world, wanted.get("world_points", world), "sdf", radius)


@each_file
def test_they_are_rewritten_without_loss(path: Path) -> None:
    document = unpack(path.read_bytes())
    written = {pack(document, coding) for coding in (None, *CODINGS)}
    for data in written:
        assert_same(unpack(data), document)


@pytest.mark.parametrize("name", MALFORMED)
def test_malformed_files_are_refused(name: str) -> None:
    with pytest.raises(FormatError) as caught:
        unpack((HERE / "malformed" / f"{name}.nisp").read_bytes())
    assert caught.value.section == MALFORMED[name]["section"]
    assert caught.value.field == MALFORMED[name]["field"]


@pytest.mark.parametrize("name", MALFORMED)
def test_the_specification_refuses_malformed_files(name: str) -> None:
    file = (HERE / "malformed" / f"{name}.nisp").read_bytes()
    with pytest.raises(Exception):  # noqa: B017, PT011
        Reader(file)


def test_the_set_is_complete_and_small() -> None:
    stems = {path.stem for path in FILES}
    assert stems == {path.stem for path in HERE.glob("*.json")} - {"tolerance"}
    assert {path.stem for path in (HERE / "malformed").glob("*.nisp")} == set(MALFORMED)
    for coding in CODINGS:
        assert any(stem.startswith(f"coding-{coding.replace(chr(95), chr(45))}-") for stem in stems)
    files = [*HERE.glob("*.nisp"), *HERE.glob("*.json"), *HERE.glob("malformed/*")]
    assert sum(path.stat().st_size for path in files) < 500_000
