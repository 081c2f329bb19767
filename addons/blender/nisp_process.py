"""The `nisp` command in a process of its own: where it is, what it is asked, how far it is.

Without Blender. Blender's Python has numpy 1, and nispcodec wants numpy 2: in one process they do
not go together.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path
from threading import Thread

PLACES = ("nisp", "nisp.exe", "bin/nisp", "Scripts/nisp.exe")
"""Of the command, below an environment or a folder of commands."""
HOW_TO_INSTALL = "install nispcodec, and name its environment in the add-on's preferences"
PATIENCE = 10
"""Seconds for clearing up after being cancelled."""
_OF_BLENDER = ("PYTHONHOME", "PYTHONPATH")
_WARNING, _ERROR = "nisp: warning: ", "nisp: error: "
_SHARE = re.compile(r"\w+ +(\d+) %")


class NispFailed(Exception):
    """A sentence for the user: there is no command, or it did not succeed."""


def nisp_command(named: str) -> str:
    """The path of the command in what the preferences name: itself, a folder, an environment.

    With "" that on PATH. Raises NispFailed where there is none.
    """
    if not named:
        found = shutil.which("nisp")
        if found is None:
            raise NispFailed(f"expected the command nisp on PATH, found none: {HOW_TO_INSTALL}")
        return found
    path = Path(named)
    for each in [path, *(path / place for place in PLACES)]:
        if each.is_file() and os.access(each, os.X_OK):
            return str(each)
    raise NispFailed(f"{named}: expected the command nisp or its environment, found none")


def decoding(model: Path, mesh: Path, resolution: int, faces: int) -> list[str]:
    """The arguments that write a model as a mesh; 0 leaves a number to the decoder."""
    numbers = {"--resolution": resolution, "--faces": faces}
    chosen = [text for name, value in numbers.items() if value for text in (name, str(value))]
    return ["decode", str(model), "-o", str(mesh), *chosen, "--progress", "plain"]


def encoding(mesh: Path, model: Path, preset: str) -> list[str]:
    """The arguments that encode a mesh; whatever has the model's name is overwritten."""
    options = ["--preset", preset, "--force", "--progress", "plain"]
    return ["encode", str(mesh), "-o", str(model), *options]


class NispProcess:
    """A run of the command, listened to until it ends.

    share is how much is done, 0 to 1, and line what it said of that last; warnings are those that
    it gave.
    """

    def __init__(self, command: Sequence[str]) -> None:
        self.share = 0.0
        self.line = ""
        self.warnings: list[str] = []
        self.cancelled = False
        self._last = ""
        self._process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            encoding="utf-8",
            errors="replace",
            env=_environment(),
            creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
        )
        self._ear = Thread(target=self._listen, daemon=True)
        self._ear.start()

    @property
    def ended(self) -> bool:
        """Whether it has ended, and all it said was heard."""
        return self._process.poll() is not None and not self._ear.is_alive()

    def cancel(self) -> None:
        """End it, and wait until it has cleared up."""
        self.cancelled = True
        self._process.terminate()
        try:
            self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def wait(self) -> None:
        """Wait until it has ended.

        Raises NispFailed where it was cancelled, and, in its own words, where it failed.
        """
        self._ear.join()
        failed = self._process.wait() != 0
        if self.cancelled:
            raise NispFailed("cancelled")
        if failed:
            raise NispFailed(self._last or "nisp ended with an error, and said nothing")

    def _listen(self) -> None:
        assert self._process.stderr is not None
        for line in self._process.stderr:
            self._hear(line.strip())

    def _hear(self, line: str) -> None:
        if line.startswith(_WARNING):
            self.warnings.append(line.removeprefix(_WARNING))
        elif told := _SHARE.match(line):
            self.share, self.line = int(told[1]) / 100, line
        elif line:
            self._last = line.removeprefix(_ERROR)


def _environment() -> dict[str, str]:
    """Without what would make another Python take Blender's packages for its own."""
    kept = {name: value for name, value in os.environ.items() if name not in _OF_BLENDER}
    return {**kept, "PYTHONIOENCODING": "utf-8"}
