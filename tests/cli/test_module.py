"""`python -m nispcodec` is `nisp`."""

from __future__ import annotations

import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest


def run(*arguments: object, code: str = "") -> subprocess.CompletedProcess[str]:
    start = ["-c", code] if code else ["-m", "nispcodec"]
    command = [sys.executable, *start, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_it_does_what_nisp_does(model: Path) -> None:
    done = run("verify", model)
    assert (done.returncode, done.stdout) == (0, f"{model}: sound\n")


def test_it_calls_itself_nisp() -> None:
    assert run("info", "--help").stdout.startswith("Usage: nisp info ")
    assert run("--version").stdout.startswith("nisp ")


def test_exit_codes_are_passed_on(tmp_path: Path) -> None:
    (tmp_path / "bad.nisp").write_bytes(b"bad")
    assert run("verify", tmp_path / "bad.nisp").returncode == 1
    assert run("info", tmp_path / "none.nisp").returncode == 2


@pytest.mark.parametrize("missing", ["nispcodec_cli", "click"])
def test_a_missing_command_line_is_one_sentence(missing: str) -> None:
    code = (
        f"import runpy, sys; sys.modules[{missing!r}] = None\n"
        "runpy.run_module('nispcodec', run_name='__main__')"
    )
    done = run(code=code)
    assert done.returncode == 2
    assert done.stderr == (
        f"nisp: error: the command line needs {missing}, found none: pip install nispcodec\n"
    )


def test_another_missing_module_is_not_hidden(monkeypatch: pytest.MonkeyPatch) -> None:
    module = import_module("nispcodec.__main__")
    monkeypatch.setattr(module, "import_module", lambda _: import_module("nispcodec.else"))
    with pytest.raises(ModuleNotFoundError, match="else"):
        module.main()
