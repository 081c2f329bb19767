"""README and docs: short sentences, links that lead somewhere, commands that there are."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from nispcodec_cli import COMMANDS
from nispcodec_cli import main as nisp

import nispcodec
from nispcodec.format.codings.registry import CODINGS
from nispcodec.io.save import mesh_paths
from nispcodec.model import NispModel
from nispcodec.procedural.mug import sample_asset
from tests import tiny
from tests.docs.pages import PAGES, ROOT, commands, links, prose, sentences

README, ARCHITECTURE = ROOT / "README.md", ROOT / "docs" / "architecture.md"
LONGEST = 25
"""Words of a sentence in the README."""


def test_the_readme_fits_on_three_screens() -> None:
    assert len(README.read_text(encoding="utf-8").splitlines()) <= 150


def test_no_sentence_of_the_readme_is_long() -> None:
    long = [each for each in sentences(README) if len(each.split()) > LONGEST]
    assert not long


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_pages_tell_no_history_and_name_nothing_that_is_not_there(page: Path) -> None:
    words = r"\b(issue \d+|session|today's|the encoder before|formerly|used to|no longer)\b"
    assert not re.search(words, prose(page), re.IGNORECASE)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    missing = [target for target in links(page) if not (page.parent / target).exists()]
    assert not missing


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_commands_and_their_options_are_there(page: Path) -> None:
    for line in commands(page):
        _, name, *rest = shlex.split(line)
        if name.startswith("-") or name.isupper():
            continue
        assert name in COMMANDS, line
        context: Any = None
        known = {each for option in nisp.get_command(context, name).params for each in option.opts}
        asked = {each for each in rest if re.fullmatch(r"--?[a-z][a-z-]*", each)}
        assert asked <= {*known, "--help"}, line


def test_the_quickstart_takes_images_that_its_sample_has() -> None:
    asked = re.findall(r"=textures/(\S+)", (ROOT / "docs" / "quickstart.md").read_text("utf-8"))
    sample = sample_asset()
    written = mesh_paths(Path("sample.obj"), sample.materials, sample.textures)
    assert asked
    assert set(asked) <= {path.name for path in written}


def test_options_are_what_help_says() -> None:
    run = subprocess.run(
        [sys.executable, "docs/options.py", "--check"], cwd=ROOT, capture_output=True, text=True
    )
    assert run.returncode == 0, run.stderr


def test_python_of_the_readme_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """As it is written; but the fit is that of somebody else."""
    (code,) = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.S)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(nispcodec, "encode", lambda mesh: NispModel(tiny.document()))
    exec(compile(code, "README.md", "exec"), {})
    assert Path("out.glb").exists()
    assert capsys.readouterr().out.count("[") >= 3


def library_files_with(text: str) -> list[str]:
    """Files of the library and the command that have these letters."""
    paths = [*(ROOT / "nispcodec").rglob("*.py"), *(ROOT / "cli").rglob("*.py")]
    return sorted(
        str(path.relative_to(ROOT)) for path in paths if text in path.read_text(encoding="utf-8")
    )


@pytest.mark.parametrize("coding", CODINGS)
def test_a_weight_coding_is_named_in_one_line(coding: str) -> None:
    assert library_files_with(f'"{coding}"') == ["nispcodec/format/codings/registry.py"]


@pytest.mark.parametrize("preset", ["fast", "best"])
def test_a_preset_is_a_line_of_one_table(preset: str) -> None:
    """The format knows presets of the first version by number, others by name."""
    assert library_files_with(f'"{preset}"') == [
        "nispcodec/format/constants.py",
        "nispcodec/train/config.py",
    ]


@pytest.mark.parametrize("suffix", [".off", ".stl"])
def test_a_mesh_format_is_a_line_of_the_table_of_readers_or_writers(suffix: str) -> None:
    found = library_files_with(f'"{suffix}"')
    assert set(found) <= {"nispcodec/io/load.py", "nispcodec/io/save.py"}


def test_architecture_names_every_folder_and_the_files_of_its_table_are_there() -> None:
    text = ARCHITECTURE.read_text(encoding="utf-8")
    for folder in (ROOT / "nispcodec").iterdir():
        if folder.is_dir() and not folder.name.startswith("_"):
            assert f"`{folder.name}`" in text
    for name in re.findall(r"`((?:[a-z_]+/)+(?:[a-z_]+\.py)?)`", text):
        assert (ROOT / "nispcodec" / name).exists() or (ROOT / name).exists(), name
