"""The extension's manifest is what Blender asks for, and its words are those of `nisp`."""

from __future__ import annotations

import ast
import re
import tomllib
from pathlib import Path

import click
from nispcodec_cli import main as nisp

import nispcodec
from addons.blender.nisp_process import decoding, encoding
from nispcodec.encode.config import PRESETS

FOLDER = Path(__file__).parents[2] / "addons" / "blender"
MANIFEST = tomllib.loads((FOLDER / "blender_manifest.toml").read_text(encoding="utf-8"))


def test_the_manifest_has_what_blender_wants() -> None:
    assert MANIFEST["schema_version"] == "1.0.0"
    assert MANIFEST["type"] == "add-on"
    assert re.fullmatch(r"[a-z][a-z0-9_]*", MANIFEST["id"])
    assert MANIFEST["version"] == nispcodec.__version__
    assert MANIFEST["blender_version_min"] == "4.2.0"
    assert MANIFEST["license"] == ["SPDX:MIT"]
    assert MANIFEST["tags"] == ["Import-Export"]
    # Blender's limits.
    for text in (MANIFEST["tagline"], *MANIFEST["permissions"].values()):
        assert len(text) <= 64
        assert text[-1].isalnum()


def test_what_it_asks_nisp_is_understood() -> None:
    path = Path("x")
    asked = [decoding(path, path, 64, 1000), decoding(path, path, 0, 0)]
    asked += [encoding(path, path, preset) for preset in PRESETS]
    for name, *arguments in asked:
        command = nisp.get_command(click.Context(nisp), name)
        assert command is not None
        known = {option for each in command.params for option in each.opts}
        assert {each for each in arguments if each.startswith("-")} <= known
    assert len(asked[1]) == len(asked[0]) - 4


def test_its_presets_are_those_of_the_library() -> None:
    tree = ast.parse((FOLDER / "operators.py").read_text(encoding="utf-8"))
    (table,) = (
        ast.literal_eval(node.value)
        for node in tree.body
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "PRESETS"
    )
    assert {name for name, _, _ in table} == set(PRESETS) - {"paper"}


def test_only_what_needs_blender_imports_it() -> None:
    with_blender = {
        path.stem for path in FOLDER.glob("*.py") if "\nimport bpy\n" in path.read_text("utf-8")
    }
    assert with_blender == {"operators", "preferences", "running"}
