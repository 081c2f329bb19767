"""What other programs are given: magic numbers, a media type, a glTF extension and its sample."""

from __future__ import annotations

import json
import re
import runpy
import shutil
import subprocess
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

from nispcodec import load_mesh
from nispcodec.format import unpack
from nispcodec.format.constants import SIGNATURE
from nispcodec.model import NispModel

DOCS = Path(__file__).parents[2] / "docs"
CONFORMANCE = Path(__file__).parents[1] / "conformance"
GLTF = DOCS / "gltf"
MEDIA_TYPE = "model/vnd.nisp"


def test_desktops_know_the_signature() -> None:
    spaces = {"": "http://www.freedesktop.org/standards/shared-mime-info"}
    kind = ET.parse(DOCS / "mime" / "nisp.xml").getroot().find("mime-type", spaces)
    assert kind is not None
    assert kind.get("type") == MEDIA_TYPE
    match, glob = kind.find("magic/match", spaces), kind.find("glob", spaces)
    assert match is not None
    assert glob is not None
    assert str(match.get("value")).encode().decode("unicode_escape").encode("latin-1") == SIGNATURE
    assert (match.get("offset"), glob.get("pattern")) == ("0", "*.nisp")


def test_the_magic_file_has_the_signature() -> None:
    lines = (DOCS / "mime" / "nisp.magic").read_text().splitlines()
    rows = [line.split("\t") for line in lines if re.match(r"\d", line)]
    assert rows[0][2].encode().decode("unicode_escape").encode("latin-1") == SIGNATURE
    assert f"!:mime\t{MEDIA_TYPE}" in lines


@pytest.mark.skipif(shutil.which("file") is None, reason="the command file is not installed")
def test_file_says_what_it_is() -> None:
    magic, path = DOCS / "mime" / "nisp.magic", CONFORMANCE / "uv-map.nisp"
    run = subprocess.run(["file", "-b", "-m", magic, path], capture_output=True, text=True)
    assert run.stdout.strip() == "nisp neural 3D asset, version 1.0, 3 sections"


def test_the_page_names_the_media_type_and_the_signature() -> None:
    page = (DOCS / "engines.md").read_text()
    assert f"`{MEDIA_TYPE}`" in page
    assert f"`{SIGNATURE.hex(' ').upper()}`" in page


def test_the_sample_is_what_its_script_writes() -> None:
    assert runpy.run_path(str(GLTF / "sample.py"))["sample"]() == (GLTF / "sample.glb").read_bytes()


def test_both_surfaces_of_the_sample_are_one() -> None:
    tree, binary = runpy.run_path(str(GLTF / "sample.py"))["parts"](
        (GLTF / "sample.glb").read_bytes()
    )
    assert tree["extensionsUsed"] == ["NISP_neural_mesh"]
    assert "extensionsRequired" not in tree
    extension = tree["meshes"][0]["extensions"]["NISP_neural_mesh"]
    view = tree["bufferViews"][extension["bufferView"]]
    start = view["byteOffset"]
    document = unpack(binary[start : start + view["byteLength"]])
    assert len(extension["materials"]) == len(document.materials)
    mesh = load_mesh(GLTF / "sample.glb")
    model = NispModel(document)
    middles = mesh.positions[mesh.faces].mean(axis=1)
    assert model.sdf(np.concatenate([mesh.positions, middles])) == pytest.approx(0, abs=1e-6)
    corners = mesh.positions[mesh.faces]
    outwards = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert ((outwards * middles).sum(axis=1) > 0).all()


def test_schema_and_page_name_the_same_properties() -> None:
    schema = json.loads((GLTF / "schema" / "mesh.NISP_neural_mesh.schema.json").read_text())
    page = (GLTF / "README.md").read_text()
    own = set(schema["properties"]) - {"extensions", "extras"}
    assert own == set(re.findall(r"^\| (\w+) \| integer", page, re.M))
    example = json.loads(re.findall(r"```json\n(.*?)```", page, re.S)[0])
    assert set(example["meshes"][0]["extensions"]["NISP_neural_mesh"]) == own
