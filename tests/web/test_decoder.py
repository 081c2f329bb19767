"""The JavaScript decoder, in node and in Chromium: every conformance file, every malformed one."""

from __future__ import annotations

import base64
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nispcodec.core.document import Document
from nispcodec.core.texture import decode_image
from nispcodec.format import unpack
from nispcodec.format.constants import NETS
from nispcodec.format.document import inspect
from nispcodec.infer.evaluate import gradient
from nispcodec.model import NispModel
from tests.web.programs import answers, answers_in_browser

CONFORMANCE = Path(__file__).parent.parent / "conformance"
FILES = sorted(CONFORMANCE.glob("*.nisp"))
MALFORMED = json.loads((CONFORMANCE / "malformed" / "expected.json").read_text())
Ask = Callable[[list[dict[str, Any]], Path], list[dict[str, Any]]]
TOLERANCE = json.loads((CONFORMANCE / "tolerance.json").read_text())


def images(document: Document) -> list[dict[str, Any]]:
    """The document's images, decoded, as answers.mjs takes them: node has no image decoder."""
    return [
        {
            "width": pixels.shape[1],
            "height": pixels.shape[0],
            "floats": base64.b64encode(pixels.tobytes()).decode(),
        }
        for pixels in map(decode_image, document.textures)
    ]


def request_of(path: Path, kernel: str) -> dict[str, Any]:
    points = json.loads(path.with_suffix(".json").read_text())["points"]
    found = images(unpack(path.read_bytes()))
    return {"path": str(path), "points": points, "images": found, "kernel": kernel}


@pytest.fixture(
    scope="module", params=["node wasm", "node plain", "chromium wasm", "chromium plain"]
)
def found(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Any:
    """Answers by name of the file, for either way of computing."""
    program, kernel = request.param.split()
    ask = answers if program == "node" else answers_in_browser
    requests = [request_of(path, kernel) for path in FILES]
    listed = ask(requests, tmp_path_factory.mktemp("answers"))
    return {path.stem: answer for path, answer in zip(FILES, listed, strict=True)}


@pytest.mark.parametrize("path", FILES, ids=[path.stem for path in FILES])
def test_it_answers_as_the_specification_says(path: Path, found: Any) -> None:
    wanted, answer = json.loads(path.with_suffix(".json").read_text()), found[path.stem]
    assert "error" not in answer, answer
    field = unpack(path.read_bytes()).field
    scale = np.maximum(np.abs(field.charts.uv_scale), 1) if field else 1.0
    for kind, unit in (("sdf", 1.0), ("uv", scale), ("color", 1.0)):
        # Numbers that JSON cannot hold are strings there.
        expected, found_values = np.array(wanted[kind], float), np.array(answer[kind], float)
        near = np.isclose(
            found_values.reshape(expected.shape) / unit,
            expected / unit,
            rtol=0,
            atol=TOLERANCE[kind],
            equal_nan=True,
        )
        assert near.all(), kind
    assert answer["chart"] == wanted["chart"]


@pytest.mark.parametrize("path", FILES, ids=[path.stem for path in FILES])
def test_gradients_are_those_of_the_library(path: Path, found: Any) -> None:
    points = np.array(json.loads(path.with_suffix(".json").read_text())["points"], np.float32)
    document = unpack(path.read_bytes())
    answer = np.reshape(found[path.stem]["gradient"], points.shape)
    if document.field and not document.meshes:
        _, expected = gradient(document.field.sdf, points)
    else:
        answer = answer / np.linalg.norm(answer, axis=1, keepdims=True)
        expected = NispModel(document).normals(points, "normalized")
    off = answer - expected
    assert (np.abs(off) <= 2e-3 * (1 + np.linalg.norm(expected, axis=1)[:, None])).all()


@pytest.mark.parametrize("path", FILES, ids=[path.stem for path in FILES])
def test_bytes_are_split_as_the_library_does(path: Path, found: Any) -> None:
    sections = inspect(path.read_bytes())
    expected = {each.code: each.stored_length for each in sections}
    for each in sections:
        if each.code == NETS:
            expected |= {f"{NETS}.{name}": length for name, length in each.parts.items()}
    # Halves of a byte may be rounded another way.
    assert found[path.stem]["bytes"] == pytest.approx(expected, abs=1)


@pytest.mark.parametrize("ask", [answers, answers_in_browser])
def test_malformed_files_are_refused(ask: Ask, tmp_path: Path) -> None:
    request: dict[str, Any] = {"points": [], "images": [], "kernel": "plain"}
    paths = [CONFORMANCE / "malformed" / f"{name}.nisp" for name in MALFORMED]
    found = ask([{**request, "path": str(path)} for path in paths], tmp_path)
    for name, answer in zip(MALFORMED, found, strict=True):
        assert answer.get("error") == "NISPError", (name, answer)
        assert "expected" in answer["message"], name
