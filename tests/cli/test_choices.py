"""Every list of choices is the library's own, and is asked for only when a subcommand runs."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterable

import pytest
from nispcodec_cli import COMMANDS, grid
from nispcodec_cli.choices import LibraryChoice

from nispcodec.core.slots import SLOTS
from nispcodec.encode.config import IMAGE_FORMATS, PRESETS, TEXTURE_FORMATS
from nispcodec.format.codings.registry import CODINGS
from nispcodec.io.load import READERS
from nispcodec.io.save import SUFFIXES
from nispcodec.model import FRAMES
from nispcodec.render import camera, channels, images
from nispcodec.train.prune import STRATEGIES
from tests.cli.conftest import done, nisp, refused


@pytest.mark.parametrize(
    ("command", "option", "names"),
    [
        ("encode", "--preset", PRESETS),
        ("encode", "--texture-format", TEXTURE_FORMATS),
        ("encode", "--prune", STRATEGIES),
        ("recode", "--texture-format", IMAGE_FORMATS),
        ("recode", "--coding", CODINGS),
        ("decode", "--output FILE", [*SUFFIXES, grid.SUFFIX]),
        ("render", "--output FILE", images.SUFFIXES),
        ("sheet", "--output FILE", images.EXACT),
        ("render", "--channel", channels.CHANNELS),
        ("render", "--view", [*camera.NAMED, "AZIMUTH,ELEVATION"]),
        ("query", "--frame", FRAMES),
        ("retexture", "--slot", SLOTS),
    ],
)
def test_the_help_has_the_names_of_the_library(
    command: str, option: str, names: Iterable[str]
) -> None:
    text = done(command, "--help").stdout
    assert re.search(rf"{option} *\[{re.escape('|'.join(names))}\]", text), text


@pytest.mark.parametrize(
    ("arguments", "names"),
    [
        (("encode", "a", "--preset", "x"), PRESETS),
        (("recode", "a", "--coding", "x"), CODINGS),
        (("render", "a", "--channel", "x"), channels.CHANNELS),
        (("retexture", "a", "--slot", "x=y"), SLOTS),
        (("encode", "a", "--prune", "x"), STRATEGIES),
    ],
)
def test_another_name_is_answered_with_the_list(
    arguments: tuple[str, ...], names: Iterable[str]
) -> None:
    option = arguments[2]
    refused(nisp(*arguments), f"{option}: expected one of {', '.join(names)}, found 'x'")


def test_the_meshes_that_can_be_read_are_in_the_help() -> None:
    assert f"({' '.join(READERS)})" in done("encode", "--help").stdout


def test_a_library_is_asked_once_and_late() -> None:
    calls = []

    def names() -> tuple[str, ...]:
        calls.append(1)
        return ("a", "b")

    choice = LibraryChoice(names)
    assert calls == []
    assert choice.convert("a", None, None) == choice.convert("a", None, None) == "a"
    assert choice.choices == ("a", "b")
    assert len(calls) == 1


def loaded_after(code: str) -> set[str]:
    script = f"{code}\nimport sys\nprint(*sys.modules)"
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    return set(run.stdout.splitlines()[-1].split())


def test_loading_every_subcommand_loads_nothing_of_the_library() -> None:
    names = ", ".join(COMMANDS)
    modules = loaded_after(f"from nispcodec_cli import {names}")
    assert not {"numpy", "torch", "rich", "nispcodec", "PIL", "scipy"} & modules


@pytest.mark.parametrize("command", COMMANDS)
def test_the_help_of_a_subcommand_needs_no_optional_package(command: str) -> None:
    code = (
        "import sys\n"
        "for name in ('torch', 'igl', 'skimage', 'embreex', 'xatlas', 'rich'):\n"
        "    sys.modules[name] = None\n"
        "from click.testing import CliRunner; from nispcodec_cli import main\n"
        f"assert CliRunner().invoke(main, [{command!r}, '--help']).exit_code == 0"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
