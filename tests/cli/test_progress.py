"""Progress: a line each ten percent of the whole without a terminal, one bar for it with one."""

from __future__ import annotations

import os
import pty
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from nispcodec_cli.bars import Bars
from nispcodec_cli.lines import Lines, Whole, duration, facts
from nispcodec_cli.progress import shown

from nispcodec.core.errors import FitError
from nispcodec.core.progress import Progress, silent
from tests import tiny
from tests.cli.conftest import UPDATES, done, nisp

LONG = ("encode", "decode", "render", "sheet", "compare")
Captured = pytest.CaptureFixture[str]
PERCENT = re.compile(r"^encode +(\d+) %", re.MULTILINE)


def lines(updates: list[Progress], capsys: Captured) -> list[str]:
    with Lines("encode") as listen:
        for update in updates:
            listen(update)
    return capsys.readouterr().err.splitlines()


def test_a_line_each_ten_percent_of_the_whole_and_not_of_each_network(
    capsys: Captured,
) -> None:
    updates = [
        Progress(network, "fit", step, 1000, overall=step / 1000)
        for step in range(1001)
        for network in ("sdf", "chart", "uv")
    ]
    text = "\n".join(lines(updates, capsys))
    assert [int(each) for each in PERCENT.findall(text)] == list(range(10, 101, 10))
    assert len(text.splitlines()) == 10


def test_a_line_says_what_is_done_and_how_long_it_takes_yet(
    capsys: Captured,
) -> None:
    first, last = lines(UPDATES[2:], capsys)[-2:]
    assert re.fullmatch(r"encode  50 %, about .* s left: sdf fit 11 %, uv fit 50 %", first)
    assert re.fullmatch(r"encode 100 %: .* s", last)


def test_a_leap_is_one_line(capsys: Captured) -> None:
    told = lines([Progress(stage="a", overall=0.0), Progress(stage="b", overall=0.9)], capsys)
    assert PERCENT.findall("\n".join(told)) == ["90", "100"]


def test_a_note_is_a_line_of_its_own(capsys: Captured) -> None:
    assert lines(UPDATES, capsys).count("sdf fit: diverged at step 11, retrying") == 1


def test_who_fails_is_not_said_to_be_done(capsys: Captured) -> None:
    with pytest.raises(FitError), Lines("encode"):
        raise FitError("no")
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize(
    ("update", "share"),
    [
        (Progress(stage="views", step=1, steps=4), 0.25),
        (Progress("sdf", "fit", step=1, steps=4), 0.0),
        (Progress("sdf", "fit", step=1, steps=4, overall=0.6), 0.6),
        (Progress(stage="samples"), 0.0),
    ],
)
def test_the_share_of_the_whole(update: Progress, share: float) -> None:
    whole = Whole()
    whole.hear(update)
    assert whole.share == share


def test_the_share_never_falls() -> None:
    whole = Whole()
    for share in (0.5, 0.2, float("nan"), 7.0):
        whole.hear(Progress("sdf", "fit", overall=share))
        assert whole.share == max(0.5, min(share, 1.0) if share > 1 else 0.5)


@pytest.mark.parametrize("command", LONG)
def test_long_commands_have_the_options(command: str) -> None:
    text = done(command, "--help").stdout
    assert "--progress [auto|none|bar|plain]" in text
    assert "--quiet" in text


@pytest.fixture
def encode(encoder: Any, mesh: Path, tmp_path: Path) -> Any:
    """Runs `nisp encode` with a stand-in for the encoder and some options."""
    encoder(tiny.document())
    return lambda *options: done("encode", mesh, "-o", tmp_path / "out.nisp", *options)


def test_without_a_terminal_there_are_plain_lines(encode: Any) -> None:
    assert PERCENT.findall(encode().stderr) == ["10", "50", "100"]
    assert encode("--progress", "plain").stderr.count("%") == encode().stderr.count("%")


@pytest.mark.parametrize("options", [("--quiet",), ("--progress", "none")])
def test_quiet_is_none(encode: Any, options: tuple[str, ...]) -> None:
    assert encode(*options).stderr == ""
    assert encode("--progress", "plain", "--quiet").stderr == ""


def test_bars_where_they_are_asked_for(encode: Any) -> None:
    pytest.importorskip("rich", reason="rich is not installed")
    assert "━" in encode("--progress", "bar").stderr


@pytest.fixture
def no_rich(monkeypatch: pytest.MonkeyPatch) -> None:
    """As on a machine without rich."""
    for name in [each for each in sys.modules if each.partition(".")[0] == "rich"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "rich", None)


def test_without_rich_lines_take_the_place_of_bars(no_rich: None, encode: Any) -> None:
    said = encode("--progress", "bar").stderr
    assert (
        "nisp: warning: --progress bar needs rich, which is not installed: pip install rich" in said
    )
    assert PERCENT.findall(said) == ["10", "50", "100"]


def kind(listen: Any) -> str:
    """What is shown: `none`, `plain` or `bar`."""
    with listen as listener:
        return "none" if listener is silent else {Bars: "bar", Lines: "plain"}[type(listener)]


class Terminal:
    """Standard error that says it is a terminal."""

    def isatty(self) -> bool:
        return True

    def write(self, text: str) -> int:
        return len(text)

    def flush(self) -> None: ...


@pytest.mark.parametrize(("term", "expected"), [("xterm", "bar"), ("dumb", "plain")])
def test_auto_draws_bars_on_a_terminal(
    term: str, expected: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("rich", reason="rich is not installed")
    monkeypatch.setenv("TERM", term)
    monkeypatch.setattr(sys, "stderr", Terminal())
    assert kind(shown("encode", "auto", False)) == expected


def test_auto_without_rich_is_plain_on_a_terminal_too(
    no_rich: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys, "stderr", Terminal())
    assert kind(shown("encode", "auto", False)) == "plain"


def test_there_is_one_bar_for_the_whole_and_one_a_network(
    capsys: Captured,
) -> None:
    pytest.importorskip("rich", reason="rich is not installed")
    with Bars("encode") as listen:
        for update in UPDATES:
            listen(update)
        assert [task.description for task in listen._rows.tasks] == ["encode", "sdf fit", "uv fit"]
        assert listen._rows.tasks[0].percentage == 50
    text = capsys.readouterr().err
    assert "100 %" in text
    assert text.count("diverged at step 11") == 1


def test_a_real_terminal_gets_a_bar_and_the_result_apart(model: Path, tmp_path: Path) -> None:
    pytest.importorskip("rich", reason="rich is not installed")
    ours, theirs = pty.openpty()
    command = [sys.executable, "-m", "nispcodec", "render", model, "-o", tmp_path / "out.png"]
    run = subprocess.run(
        [*map(str, command), "--size", "16"],
        stdout=subprocess.PIPE,
        stderr=theirs,
        env={**os.environ, "TERM": "xterm"},
        check=True,
    )
    os.close(theirs)
    shown_there = os.read(ours, 65536).decode()
    os.close(ours)
    assert "render" in shown_there
    assert "━" in shown_there
    assert run.stdout.decode().startswith(f"{tmp_path / 'out.png'}: ")


@pytest.mark.parametrize(
    ("arguments", "title"),
    [
        (("decode", "tiny.nisp", "-o", "o.glb", "--resolution", 16), "decode"),
        (("render", "tiny.nisp", "-o", "o.webp", "--size", 16, "--turntable", 3), "render"),
        (("sheet", "ball.obj", "ball.obj", "-o", "o.png", "--size", 32), "sheet"),
        (("compare", "ball.obj", "tiny.nisp", "--resolution", 16, "--samples", 200), "compare"),
    ],
)
def test_other_long_work_tells_its_share_too(
    model: Path,
    mesh: Path,
    tmp_path: Path,
    arguments: tuple[object, ...],
    title: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    said = nisp(*arguments).stderr.splitlines()
    assert len(said) > 1
    assert all(line.startswith(f"{title} ") and " %" in line for line in said)
    assert said[-1].startswith(f"{title} 100 %")


def test_what_is_known_of_a_network_stands_at_its_bar() -> None:
    assert facts(UPDATES[1]) == ["10/100", "loss 5.0e-01", "held-out 1.0e-03", "1 min 15 s left"]
    assert facts(UPDATES[0]) == []


def test_duration() -> None:
    assert duration(0.44) == "0.4 s"
    assert duration(18.4) == "18 s"
    assert duration(119.6) == "2 min 0 s"
