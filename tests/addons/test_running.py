"""An operator that waits: it shows progress, ends when nisp does or Esc is pressed, clears up.

Blender's part is played by stubs; `test_in_blender.py` has the real one, without a window.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

from addons.blender.nisp_process import NispFailed

TIMER, ESCAPE = SimpleNamespace(type="TIMER", value=""), SimpleNamespace(type="ESC", value="PRESS")
MOVE = SimpleNamespace(type="MOUSEMOVE", value="")


@pytest.fixture
def running(monkeypatch: pytest.MonkeyPatch) -> Iterator[ModuleType]:
    bpy: Any = ModuleType("bpy")
    bpy.app = SimpleNamespace(background=False)
    monkeypatch.setitem(sys.modules, "bpy", bpy)
    yield importlib.import_module("addons.blender.running")
    del sys.modules["addons.blender.running"]


class Screen:
    """What Blender shows: the manager of windows, the workspace and the window in one."""

    def __init__(self) -> None:
        self.percent: list[float] = []
        self.status: list[str | None] = []
        self.timers = 0
        self.window = self.window_manager = self.workspace = self

    def progress_begin(self, low: float, high: float) -> None:
        self.percent.append(low)

    def progress_update(self, value: float) -> None:
        self.percent.append(value)

    def progress_end(self) -> None:
        self.percent.append(-1)

    def event_timer_add(self, seconds: float, window: object) -> str:
        self.timers += 1
        return "timer"

    def event_timer_remove(self, timer: str) -> None:
        self.timers -= 1

    def modal_handler_add(self, operator: object) -> None:
        pass

    def status_text_set(self, text: str | None) -> None:
        self.status.append(text)


class Asked:
    """What an operator says, and what it is asked to begin and to finish."""

    bl_label = "Import"
    code = ""

    def __init__(self) -> None:
        self.reports: list[tuple[str, str]] = []
        self.finished = False

    def report(self, levels: set[str], text: str) -> None:
        (level,) = levels
        self.reports.append((level, text))

    def begin(self, context: object, mesh: Path) -> list[str]:
        if not self.code:
            raise NispFailed("no nisp")
        return [sys.executable, "-c", self.code]

    def finish(self, mesh: Path) -> None:
        self.finished = True


def operator(running: ModuleType, code: str) -> Any:
    """One that runs this in place of nisp."""
    return type("Operator", (Asked, running.RunsNisp), {"code": code})()


def until_ended(made: Any, screen: Screen) -> Any:
    while (result := made.modal(screen, TIMER)) == {"PASS_THROUGH"}:
        made.modal(screen, MOVE)
    return result


def test_it_shows_progress_until_nisp_has_ended(running: ModuleType) -> None:
    told = "import sys; print('decode  50 %: half', file=sys.stderr, flush=True); "
    told += "print('nisp: warning: odd', file=sys.stderr); import time; time.sleep(0.5)"
    screen, made = Screen(), operator(running, told)
    assert made.execute(screen) == {"RUNNING_MODAL"}
    assert screen.timers == 1
    assert until_ended(made, screen) == {"FINISHED"}
    assert made.finished
    assert made.reports == [("WARNING", "odd")]
    assert 50 in screen.percent
    assert "decode  50 %: half   (Esc cancels)" in screen.status
    assert (screen.percent[-1], screen.status[-1], screen.timers) == (-1, None, 0)
    assert not Path(made._folder.name).exists()


def test_escape_cancels(running: ModuleType) -> None:
    screen, made = Screen(), operator(running, "import time; time.sleep(100)")
    made.execute(screen)
    assert made.modal(screen, MOVE) == {"PASS_THROUGH"}
    assert made.modal(screen, ESCAPE) == {"CANCELLED"}
    assert made.reports == [("INFO", "cancelled")]
    assert (screen.status[-1], screen.timers, made.finished) == (None, 0, False)
    assert not Path(made._folder.name).exists()


def test_blender_that_closes_ends_it(running: ModuleType) -> None:
    screen, made = Screen(), operator(running, "import time; time.sleep(100)")
    made.execute(screen)
    made.cancel(screen)
    assert made._process.ended or made._process.cancelled
    assert not Path(made._folder.name).exists()


@pytest.mark.parametrize("code", ["", "import sys; sys.exit('nisp: error: no such file')"])
def test_a_failure_is_an_error_report(running: ModuleType, code: str) -> None:
    screen, made = Screen(), operator(running, code)
    result = made.execute(screen)
    if code:
        result = until_ended(made, screen)
    assert result == {"CANCELLED"}
    assert made.reports == [("ERROR", "no such file" if code else "no nisp")]
    assert not made.finished
