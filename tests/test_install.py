"""What is installed, by which extra, and what works without any."""

from __future__ import annotations

import ast
import importlib.metadata
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

import nispcodec
from nispcodec.core.extras import DISTRIBUTIONS, require
from nispcodec.format import pack
from tests import tiny

ROOT = Path(__file__).parent.parent
PYPROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
EXTRAS = PYPROJECT["project"]["optional-dependencies"]
# Not one of these is there after a plain `pip install nispcodec`.
ABSENT = ("torch", "scipy", "igl", "embreex", "skimage", "xatlas", "rich", "trimesh", "pxr")
# Whatever stands here runs without them; encoding and what it needs does not.
PLAIN = ("core", "io", "format", "infer", "extract", "edit", "procedural", "metrics", "render")

BEGINNING = f"import sys; sys.modules.update(dict.fromkeys({ABSENT}))\n"
COMMAND = (
    BEGINNING + "import nispcodec_cli\n"
    "nispcodec_cli.main(sys.argv[1:], prog_name='nisp', standalone_mode=True)"
)


def nisp(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    """The command, on a machine where nothing of any extra is installed."""
    command = [sys.executable, "-c", COMMAND, *map(str, arguments)]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True)


def works(*arguments: str | Path) -> str:
    run = nisp(*arguments)
    assert run.returncode == 0, run.stderr
    return run.stdout


@pytest.fixture
def model(tmp_path: Path) -> Path:
    """An octahedron in two charts with a texture, as a file."""
    path = tmp_path / "model.nisp"
    path.write_bytes(pack(tiny.document()))
    return path


@pytest.mark.slow
def test_a_plain_install_decodes_queries_verifies_and_converts(model: Path, tmp_path: Path) -> None:
    assert "sound" in works("verify", model)
    assert works("info", model)
    for name in ("out.glb", "out.obj", "other.ply", "out.stl"):
        works("decode", model, "-o", tmp_path / name, "--resolution", "24")
    works("decode", model, "-o", tmp_path / "few.glb", "--resolution", "24", "--faces", "100")
    points = tmp_path / "points.csv"
    points.write_text("0,0,0\n0.5,0.1,0.2\n")
    works("query", model, points, "-o", tmp_path / "answers.csv")
    assert len((tmp_path / "answers.csv").read_text().splitlines()) == 3
    works("recode", model, "-o", tmp_path / "again.nisp", "--texture-format", "webp")
    works("unpack", model, "-o", tmp_path / "images")
    image = next((tmp_path / "images").iterdir())
    works("retexture", model, "--slot", f"base_color={image}", "-o", tmp_path / "new.nisp")
    assert "sound" in works("verify", tmp_path / "new.nisp")
    works("sample", "-o", tmp_path / "demo")


# The command, the extra that it needs: {0} is a model, {1} a mesh, {2} what to write.
LACKING = [
    ("encode {1} -o {2}.nisp", "encode"),
    ("batch {1} -o {2}", "encode"),
    ("encode {1} --unwrap -o {2}.nisp", "unwrap"),
    ("decode {0} --rebake 16 --resolution 16 --faces 100 -o {2}.glb", "unwrap"),
    ("decode {0} --resolution 16 -o {2}.usdz", "usd"),
    ("render {0} --size 16 -o {2}.png", "render"),
    ("compare {1} {1}", "render"),
    ("sheet {1} {0} --size 32 -o {2}.png", "render"),
]


@pytest.mark.parametrize(("command", "extra"), LACKING)
def test_a_missing_extra_is_one_sentence_that_says_what_to_install(
    command: str, extra: str, model: Path, tmp_path: Path
) -> None:
    mesh, out = tmp_path / "mesh.glb", tmp_path / "out"
    nispcodec.write_mesh(nispcodec.load(model).to_mesh(16), mesh)
    run = nisp(*command.format(model, mesh, out).split())
    assert run.returncode == 2, run.stderr
    what = rf".+ needs .+ not installed: pip install 'nispcodec\[{extra}\]'"
    assert re.fullmatch(f"nisp: error: {what}\n", run.stderr)
    assert not list(tmp_path.glob("out*"))


def test_what_a_plain_install_uses_imports_nothing_else() -> None:
    paths = [path for folder in PLAIN for path in (ROOT / "nispcodec" / folder).rglob("*.py")]
    names = [".".join(path.relative_to(ROOT).with_suffix("").parts) for path in paths]
    names += ["nispcodec.model", "nispcodec.bake.rebake", "nispcodec.bake.unwrap"]
    code = BEGINNING + "import importlib\n"
    code += f"for name in {[name.removesuffix('.__init__') for name in names]}:\n"
    code += "    importlib.import_module(name)"
    run = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr


def requirements(extra: str) -> set[str]:
    """The distributions that an extra of nispcodec installs."""
    return {re.split(r"[<>=\[ ]", each)[0] for each in EXTRAS[extra]}


def calls_of_require() -> Iterator[ast.Call]:
    for path in (ROOT / "nispcodec").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "require":
                yield node


def test_an_extra_that_is_asked_for_has_what_is_needed() -> None:
    calls = list(calls_of_require())
    assert calls
    for call in calls:
        (extra,) = (each.value for each in call.keywords if each.arg == "extra")
        wanted = {ast.literal_eval(each) for each in call.args}
        assert {DISTRIBUTIONS.get(each, each) for each in wanted} <= requirements(
            ast.literal_eval(extra)
        )


def test_all_is_every_extra_of_the_library() -> None:
    assert EXTRAS["all"] == ["nispcodec[encode,torch,render,unwrap,gltf,usd,trimesh,remote]"]


def test_what_is_there_is_not_complained_about() -> None:
    require("numpy", "PIL", extra="encode", what_for="nothing")


def test_several_missing_packages_are_named_as_one_installs_them(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(sys.modules, "igl", None)
    monkeypatch.setitem(sys.modules, "skimage", None)
    said = "x needs libigl and scikit-image, which are not installed: "
    with pytest.raises(nispcodec.NispError, match=re.escape(said)):
        require("igl", "numpy", "skimage", extra="render", what_for="x")


def test_every_package_is_in_the_distribution() -> None:
    folders = {path.parent for path in (ROOT / "nispcodec").rglob("__init__.py")}
    found = {".".join(folder.relative_to(ROOT).parts) for folder in folders}
    listed = PYPROJECT["tool"]["setuptools"]["packages"]
    assert listed == sorted(found | {"nispcodec_cli", "nispcodec_web"})


def test_the_version_is_said_once() -> None:
    stale = "another version is installed: make setup"
    assert importlib.metadata.version("nispcodec") == nispcodec.__version__, stale
    for name in ("pyproject.toml", *(f"cli/{path.name}" for path in (ROOT / "cli").glob("*.py"))):
        text = (ROOT / name).read_text(encoding="utf-8")
        assert f'"{nispcodec.__version__}"' not in text, name
