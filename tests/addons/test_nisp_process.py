"""The process that Blender starts: found, listened to, ended; its failures are sentences."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import pytest

from addons.blender.nisp_process import (
    NispFailed,
    NispProcess,
    decoding,
    encoding,
    nisp_command,
)
from nispcodec.format import pack
from tests import tiny


def running(code: str) -> NispProcess:
    """A process that does this in place of nisp."""
    return NispProcess([sys.executable, "-c", code])


def executable(path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.touch(mode=0o755)
    return path


@pytest.mark.parametrize("place", ["nisp", "bin/nisp", "Scripts/nisp.exe"])
def test_the_command_is_found_in_its_environment_and_by_its_path(
    place: str, tmp_path: Path
) -> None:
    path = executable(tmp_path / place)
    assert nisp_command(str(tmp_path)) == nisp_command(str(path)) == str(path)


def test_the_command_is_found_on_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(NispFailed, match="expected the command nisp on PATH, found none: install"):
        nisp_command("")
    path = executable(tmp_path / "nisp")
    assert nisp_command("") == str(path)


def test_a_wrong_environment_is_named(tmp_path: Path) -> None:
    (tmp_path / "nisp").touch(mode=0o644)
    with pytest.raises(NispFailed, match=r".+: expected the command nisp or its environment"):
        nisp_command(str(tmp_path))


def test_progress_and_warnings_are_heard() -> None:
    process = running(
        "import sys; e = lambda s: print(s, file=sys.stderr)\n"
        "e('encode  40 %, about 3 s left: sdf fit 12 %'); e('nisp: warning: left out x')\n"
        "e('uv fit: again')"
    )
    process.wait()
    assert process.ended
    assert process.share == 0.4
    assert process.line == "encode  40 %, about 3 s left: sdf fit 12 %"
    assert process.warnings == ["left out x"]


@pytest.mark.parametrize("said", ["nisp: error: a.nisp: expected X, found Y", ""])
def test_a_failure_is_told_in_its_own_words(said: str) -> None:
    process = running(f"import sys; print({said!r}, file=sys.stderr); sys.exit(2)")
    with pytest.raises(NispFailed, match=r"^a\.nisp: expected X" if said else "said nothing"):
        process.wait()


def test_a_cancelled_run_clears_up_and_is_over_soon(tmp_path: Path) -> None:
    half = tmp_path / "half done"
    process = running(
        "import signal, sys, time, pathlib\n"
        f"half = pathlib.Path({str(half)!r})\n"
        "signal.signal(signal.SIGTERM, lambda *_: (half.unlink(), sys.exit(1)))\n"
        "half.touch(); time.sleep(100)"
    )
    while not half.exists():
        time.sleep(0.01)
    assert not process.ended
    process.cancel()
    with pytest.raises(NispFailed, match=r"^cancelled$"):
        process.wait()
    assert not half.exists()


def test_a_python_of_its_own_is_not_led_astray(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", "packages of Blender")
    process = running("import os, sys; sys.exit('PYTHONPATH' in os.environ)")
    process.wait()


def test_nisp_decodes_and_refuses(tmp_path: Path) -> None:
    model, mesh = tmp_path / "model.nisp", tmp_path / "mesh.glb"
    model.write_bytes(pack(tiny.document()))
    nisp = nisp_command(str(Path(sys.executable).parents[1]))
    process = NispProcess([nisp, *decoding(model, mesh, 24, 200)])
    process.wait()
    assert mesh.stat().st_size > 0
    assert process.share == 1
    again = NispProcess([nisp, *encoding(tmp_path / "none.glb", model, "fast")])
    with pytest.raises(NispFailed, match=r"^.*none\.glb: expected"):
        again.wait()
