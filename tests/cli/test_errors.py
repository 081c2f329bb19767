"""One style for every error: `nisp: error: FILE: expected X, found Y`, on stderr, exit code 2."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from nispcodec_cli import COMMANDS, extras
from nispcodec_cli.errors import explained

from tests.cli.conftest import nisp, refused

PNG = b"\x89PNG\r\n\x1a\n....................."
# What comes before and after the path of a .nisp; verify has its own exit codes.
READERS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "info": ((), ()),
    "decode": ((), ("-o", "o.glb")),
    "render": ((), ("-o", "o.png")),
    "recode": ((), ("-o", "o.nisp")),
    "unpack": ((), ("-o", "o")),
    "retexture": ((), ("--slot", "base_color=p.png", "-o", "o.nisp")),
    "query": ((), ("p.csv", "-o", "o.csv")),
}


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The working folder, with all that a command wants besides a model."""
    (tmp_path / "p.csv").write_text("1,2,3\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def asked(command: str, path: str) -> tuple[str, ...]:
    before, after = READERS[command]
    return (command, *before, path, *after)


@pytest.mark.parametrize("command", READERS)
@pytest.mark.parametrize(
    ("content", "words"),
    [
        (
            b"# an OBJ\nv 0 0 0\n",
            "this is no .nisp file: expected b'\\x89NSP' first, found '# an OBJ'",
        ),
        (PNG, "this is no .nisp file: expected b'\\x89NSP' first, found b'\\x89PNG"),
        (b"\n\n\n", "this is no .nisp file"),
        (b"\xff\xfe", "this is no .nisp file"),
        (b"", "this is no .nisp file: expected some bytes, found an empty file"),
        (b"\x89NS", "section header, field file_length"),
    ],
)
def test_what_is_no_nisp_is_told_in_words(
    folder: Path, command: str, content: bytes, words: str
) -> None:
    (folder / "model.obj").write_bytes(content)
    refused(nisp(*asked(command, "model.obj")), f"nisp: error: model.obj: {words}")
    assert not list(folder.glob("o*"))


@pytest.mark.parametrize("command", [*READERS, "verify"])
@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("none.nisp", "none.nisp: expected a file, found none"),
        ("none/none.nisp", "none/none.nisp: expected a file, found none"),
        (".", ".: expected a file, found a folder"),
        ("p.csv/x", "p.csv/x: expected a file that can be read, found: Not a directory"),
    ],
)
def test_what_cannot_be_read_is_named(command: str, path: str, words: str) -> None:
    arguments = asked(command, path) if command in READERS else (command, path)
    refused(nisp(*arguments), f"nisp: error: {words}")


@pytest.mark.parametrize("command", [*READERS, "verify"])
def test_no_permission_is_told(model: Path, command: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def forbidden(path: Path) -> bytes:
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr(Path, "read_bytes", forbidden)
    arguments = asked(command, str(model)) if command in READERS else (command, model)
    refused(nisp(*arguments), f"{model}: expected a file that can be read, found: Permission")


@pytest.mark.parametrize("command", READERS)
def test_who_brings_a_mesh_is_told_how_to_get_a_nisp(mesh: Path, command: str) -> None:
    result = nisp(*asked(command, str(mesh)))
    refused(result, f"nisp: error: {mesh}: this is no .nisp", "`nisp encode` makes one of a mesh")


@pytest.mark.parametrize("arguments", [("encode", "in", "-o", "o.nisp"), ("compare", "in", "in")])
def test_who_brings_a_folder_is_told_of_batch(folder: Path, arguments: tuple[str, ...]) -> None:
    (folder / "in").mkdir()
    refused(nisp(*arguments), "nisp: error: in: expected a file, found a folder", "`nisp batch`")


def test_verify_says_that_a_mesh_is_no_nisp(mesh: Path) -> None:
    result = nisp("verify", mesh)
    assert result.exit_code == 1
    assert f"{mesh}: this is no .nisp file" in result.stdout


@pytest.mark.parametrize(
    "arguments",
    [
        ("encode", "tiny.nisp", "-o", "o.nisp"),
        ("compare", "tiny.nisp", "tiny.nisp"),
        ("sheet", "tiny.nisp", "tiny.nisp", "-o", "o.png"),
    ],
)
def test_a_nisp_in_place_of_a_mesh(model: Path, arguments: tuple[str, ...]) -> None:
    refused(nisp(*arguments), "tiny.nisp: expected a mesh file (.obj ", "found a .nisp file")


def test_a_nisp_by_another_name_is_a_nisp_still(mesh: Path, model: Path) -> None:
    renamed = model.rename(model.with_suffix(".bin"))
    result = nisp("compare", mesh, renamed, "--resolution", 16, "--samples", 200)
    assert result.exit_code == 0, result.output
    assert "charts" in result.stdout


@pytest.mark.parametrize("command", ["compare", "encode"])
@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("none.obj", "none.obj: expected a file, found none"),
        ("folder.obj", "folder.obj: expected a file, found a folder"),
        ("p.csv", "p.csv: expected one of .obj"),
        ("-", "-: expected a file, found standard input"),
    ],
)
def test_a_mesh_that_cannot_be_read_is_named(
    folder: Path, command: str, path: str, words: str
) -> None:
    (folder / "folder.obj").mkdir()
    rest = ("-o", "o.nisp") if command == "encode" else ("other.obj",)
    refused(nisp(command, path, *rest), f"nisp: error: {words}")


@pytest.mark.parametrize(
    ("output", "words"),
    [
        ("nowhere/o.glb", "nowhere: expected a folder to write into, found none"),
        ("p.csv/o.glb", "p.csv: expected a folder to write into, found a file"),
        ("o.fbx", "o.fbx: expected .glb, "),
        ("o", "o: expected .glb, .gltf, .ply, .stl, .obj, .usdz, .npz, found no suffix"),
        ("folder.glb", "folder.glb: expected a file to write, found a folder"),
    ],
)
def test_an_output_that_cannot_be_written(
    folder: Path, model: Path, output: str, words: str
) -> None:
    (folder / "folder.glb").mkdir()
    refused(nisp("decode", model, "-o", output, "--force"), f"nisp: error: {words}")


def test_a_read_only_folder(model: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "access", lambda *_: False)
    refused(nisp("decode", model, "-o", "o.glb"), "expected a folder to write into, found a read-")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("explode",), "command: expected one of encode, "),
        (("rendr",), "found 'rendr'; did you mean render?"),
        (("--jsn",), "--jsn: expected an option"),
        (("info",), "MODEL: expected a value, found none"),
        (("info", "a", "b"), "b: expected nothing more, found an argument"),
        (("info", "a", "--jsn"), "--jsn: expected an option of this command, found another"),
        (("info", "a", "--jsn"), "did you mean --json?"),
        (("info", "a", "--json=3"), "--json: expected no value, found one"),
        (("decode", "a"), "-o, --output: expected a value, found none"),
        (("decode", "a", "-o"), "-o: expected a value, found none"),
        (
            ("decode", "a", "--faces", "3"),
            "--faces: expected a whole number of 4 or more, found '3'",
        ),
        (
            ("decode", "a", "--faces", "x"),
            "--faces: expected a whole number of 4 or more, found 'x'",
        ),
        (("decode", "a", "--target-error", "0"), "--target-error: expected a number above 0"),
        (("decode", "a", "--target-error", "nan"), "expected a number above 0, found 'nan'"),
        (("render", "a", "--size", "5"), "--size: expected a whole number from 16 to 4096"),
        (("render", "a", "--fov", "wide"), "--fov: expected a number from 1 to 120, found 'wide'"),
        (("render", "a", "--view", "1"), "--view: expected front, "),
        (
            ("render", "a", "--progress", "dots"),
            "--progress: expected one of auto, none, bar, plain",
        ),
        (("encode", "a", "--target-size", "x"), "--target-size: expected a size such as"),
        (("retexture", "a", "--slot", "x"), "--slot: expected SLOT=IMAGE, found 'x'"),
        (("query", "-", "-", "-o", "-"), "MODEL and POINTS: expected one from standard input"),
    ],
)
def test_what_is_wrong_on_the_command_line(arguments: tuple[str, ...], words: str) -> None:
    refused(nisp(*arguments), words)


def test_where_to_read_more_is_said() -> None:
    refused(nisp("decode", "a", "--faces", "3"), "(see nisp decode --help)")
    refused(nisp("explode"), "(see nisp --help)")


def test_no_command_at_all_is_the_help() -> None:
    result = nisp()
    assert result.exit_code == 2
    assert all(command in result.stderr for command in COMMANDS)


def test_too_little_memory_is_no_traceback() -> None:
    assert "nisp encode: expected enough memory" in str(explained(MemoryError(), "encode"))


def test_a_closed_pipe_is_no_error_of_ours() -> None:
    assert explained(BrokenPipeError(32, "Broken pipe"), "info") is None


def without(package: str, *arguments: object) -> subprocess.CompletedProcess[str]:
    """Run the command line where a package cannot be imported."""
    code = (
        f"import sys; sys.modules[{package!r}] = None\n"
        "from nispcodec_cli import main; main(prog_name='nisp')"
    )
    command = [sys.executable, "-c", code, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.mark.parametrize(
    ("package", "named", "arguments"),
    [
        ("torch", "torch", ("encode", "ball.obj", "-o", "o.nisp", "--engine", "torch")),
        ("igl", "libigl", ("compare", "ball.obj", "ball.obj")),
        ("embreex", "embreex", ("sheet", "ball.obj", "ball.obj", "-o", "o.png", "--size", 32)),
        ("xatlas", "xatlas", ("decode", "tiny.nisp", "-o", "o.glb", "--rebake", 16)),
    ],
)
def test_a_missing_package_is_one_sentence(
    model: Path, mesh: Path, package: str, named: str, arguments: tuple[object, ...]
) -> None:
    run = without(package, *arguments)
    assert run.returncode == 2, run.stderr
    sentence = rf"nisp: error: [^\n]+ needs {named}[^\n]* not installed: pip install [^\n]+\n"
    assert re.fullmatch(sentence, run.stderr), run.stderr
    assert run.stdout == ""


REQUIRED = [
    "numpy>=2.0",
    'torch>=2.4; extra == "torch"',
    "libigl>=2.6; extra == 'encode'",
    "libigl>=2.6; extra == 'render'",
    'scikit-image>=0.24; extra == "render"',
    'fast_simplification>=0.1; python_version >= "3.11" and extra == "all"',
    'fast_simplification>=0.1; python_version >= "3.11" and extra == "unwrap"',
    'nispcodec[encode,render]; extra == "all"',
    'embreex>=2; extra == "all"',
]


@pytest.mark.parametrize(
    ("package", "command", "said"),
    [
        ("torch", "encode", "torch, which is not installed: pip install 'nispcodec[torch]'"),
        ("igl", "encode", "libigl, which is not installed: pip install 'nispcodec[encode]'"),
        ("igl", "compare", "libigl, which is not installed: pip install 'nispcodec[render]'"),
        (
            "skimage",
            "sheet",
            "scikit-image, which is not installed: pip install 'nispcodec[render]'",
        ),
        ("fast_simplification", "decode", "pip install 'nispcodec[unwrap]'"),
        ("embreex", "sheet", "embreex, which is not installed: pip install 'nispcodec[all]'"),
        ("xatlas", "decode", "xatlas, which is not installed: pip install xatlas"),
    ],
)
def test_the_extra_is_the_smallest_that_helps(
    package: str, command: str, said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(extras.metadata, "requires", lambda _: REQUIRED)
    error = ModuleNotFoundError(f"No module named {package!r}", name=f"{package}.sub")
    assert str(explained(error, command)).startswith(f"nisp {command} needs ")
    assert str(explained(error, command)).endswith(said)


def test_a_package_that_fails_to_load_is_told_apart() -> None:
    error = ImportError("libfoo.so: cannot open", name="embreex.rtcore")
    assert "which fails to load (libfoo.so" in str(explained(error, "render"))


def test_a_missing_module_of_ours_is_a_bug() -> None:
    assert explained(ModuleNotFoundError("no", name="nispcodec.nothing"), "info") is None


def test_every_error_of_a_real_process_is_one_line(mesh: Path) -> None:
    command = [sys.executable, "-m", "nispcodec", "info", str(mesh)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert run.returncode == 2
    assert run.stdout == ""
    assert run.stderr.startswith(f"nisp: error: {mesh}: this is no .nisp file")
    assert len(run.stderr.splitlines()) == 1
