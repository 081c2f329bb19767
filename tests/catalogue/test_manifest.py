from __future__ import annotations

from pathlib import Path

import pytest

from nispcodec.catalogue.find import find_assets
from nispcodec.catalogue.manifest import read_manifest
from nispcodec.catalogue.plan import Asset, Problem
from tests.catalogue.stubs import meshes


def test_a_table_has_assets_outputs_and_options(tmp_path: Path) -> None:
    meshes(tmp_path, "a", "b")
    path = tmp_path / "list.csv"
    path.write_text('\ufeffsource,output,preset,seed\na.obj,,fast,\n"b.obj",deep/c.nisp,,3\n')
    first, second = (each for each in find_assets([str(path)]) if isinstance(each, Asset))
    assert (first.source, first.output) == (str(tmp_path / "a.obj"), "a.nisp")
    assert dict(first.options) == {"preset": "fast"}
    assert first.size == (tmp_path / "a.obj").stat().st_size
    assert (second.output, dict(second.options)) == ("deep/c.nisp", {"seed": "3"})


def test_lines_of_json_have_the_same(tmp_path: Path) -> None:
    path = tmp_path / "list.jsonl"
    path.write_text(
        '{"source": "s3://bucket/a.glb", "prune_rate": {"sdf": 0.3}}\n\n{"source": "b.obj"}\n'
    )
    first, second = (each for each in read_manifest(str(path)) if isinstance(each, Asset))
    assert (first.source, first.options) == ("s3://bucket/a.glb", {"prune_rate": {"sdf": 0.3}})
    assert (second.source, second.output) == (str(tmp_path / "b.obj"), "")


@pytest.mark.parametrize(
    ("name", "text", "where", "said"),
    [
        ("m.csv", "source,presett\na.obj,fast\n", "line 1", "found 'presett'"),
        ("m.csv", "preset\nfast\n", "line 1", "expected a column source"),
        ("m.csv", "", "line 1", "expected a column source, found none"),
        ("m.csv", "source,seed\na.obj\n", "line 2", "expected 2 cells, found 1"),
        ("m.csv", 'source,seed\n"a.obj"x,1\n', "line 2", "expected a line of CSV"),
        ("m.csv", "source,seed\na.obj,many\n", "line 2", "seed: expected int, found 'many'"),
        ("m.csv", "source,preset\na.obj,slow\n", "line 2", "preset: expected one of"),
        ("m.csv", "source,unwrap\na.obj,maybe\n", "line 2", "unwrap: expected bool"),
        ("m.csv", "source,output\na.obj,../a.nisp\n", "line 2", "within the folder"),
        ("m.csv", "source,output\na.obj,/tmp/a.nisp\n", "line 2", "within the folder"),
        ("m.csv", "source,output\na.obj,a.glb\n", "line 2", "ends with .nisp"),
        ("m.jsonl", '{"source": "a.obj"', "line 1", "expected JSON"),
        ("m.jsonl", "[1]", "line 1", "expected an object"),
        ("m.jsonl", '{"source": 3}', "line 1", "source: expected a path, found 3"),
        ("m.jsonl", '{"source": "a.obj", "output": 3}', "line 1", "output: expected a path"),
        ("m.jsonl", '{"source": "a.obj", "preset": 3}', "line 1", "preset: expected text"),
        ("m.jsonl", '{"source": "a.obj", "seed": []}', "line 1", "seed: expected a whole"),
        ("m.jsonl", '{"source": "a.obj", "target_size": []}', "line 1", "target_size: expected"),
    ],
)
def test_a_line_that_is_wrong_is_a_problem_that_names_it(
    tmp_path: Path, name: str, text: str, where: str, said: str
) -> None:
    path = tmp_path / name
    path.write_text(text)
    (found,) = read_manifest(str(path))
    assert isinstance(found, Problem)
    assert found.source == f"{path} {where}"
    assert said in found.error


def test_the_other_lines_are_done(tmp_path: Path) -> None:
    meshes(tmp_path, "a")
    path = tmp_path / "list.csv"
    path.write_text("source,seed\na.obj,x\na.obj,2\ngone.obj,1\n")
    kinds = [type(each) for each in find_assets([str(path)])]
    assert kinds == [Problem, Asset, Problem]


def test_a_manifest_that_cannot_be_read_is_a_problem(tmp_path: Path) -> None:
    (found,) = read_manifest(str(tmp_path / "gone.csv"))
    assert isinstance(found, Problem)
    (tmp_path / "latin.csv").write_bytes(b"source\ncaf\xe9.obj\n")
    (found,) = read_manifest(str(tmp_path / "latin.csv"))
    assert isinstance(found, Problem)
    assert "UTF-8" in found.error
