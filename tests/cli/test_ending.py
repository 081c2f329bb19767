"""An encode that is ended in its midst leaves nothing behind: no output, no child, no traceback."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from nispcodec_cli.ending import Terminated, ending_on_sigterm

from nispcodec.io.save import write_mesh
from tests.metrics.shapes import sphere

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")

# Ends the process itself, so that the place is the same on every machine: at a stage of the encode,
# at a share of a network's fit, or while a file is read or written. The fit is a short one.
PROGRAM = """
import os, signal, sys, threading
import nispcodec, nispcodec.io.load, nispcodec.core.atomic_write
from nispcodec_cli import main
from tests.encode.tunings import small

# A shell that starts tests in the background has them ignore Ctrl-C, and so would this program.
signal.signal(signal.SIGINT, signal.default_int_handler)
place, number, options = sys.argv[1], int(sys.argv[2]), sys.argv[3:]
encode, read, sync = nispcodec.encode, nispcodec.io.load.read_obj, os.fsync
ended = False

def end():
    global ended
    if not ended:
        ended = True
        os.kill(os.getpid(), number)

def encode_until(mesh, config, progress):
    def heard(update):
        progress(update)
        share = 100 * update.step / max(update.steps, 1) if update.network else 0
        if update.stage == place or (place.isdigit() and share >= int(place)):
            end()
    return encode(mesh, config, progress=heard, tuning=small(3000, 300, 1, 100, 30))

def read_until(*arguments):
    if place == "read":
        end()
    return read(*arguments)

def sync_until(handle):
    if place == "write":
        end()
    return sync(handle)

nispcodec.encode = encode_until
nispcodec.io.load.READERS[".obj"] = read_until
os.fsync = sync_until
main(["encode", *options])
"""
PROBE = "probe how much there is to learn"
STAGES = ["charts and hidden walls", "samples", "fit", PROBE, "40", "90", "quantize", "surface"]
PLACES = ["read", *STAGES, "write"]
ENDS = [
    *((place, signal.SIGINT) for place in PLACES),
    *((place, signal.SIGTERM) for place in ("read", "40", "write")),
]


@pytest.fixture(scope="module")
def ball(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("ball") / "ball.obj"
    write_mesh(sphere(subdivisions=2), path)
    return path


def children(process: int) -> set[int]:
    """The processes of the group that `process` leads, but itself."""
    found = subprocess.run(["ps", "-e", "-o", "pid=,pgid="], capture_output=True, text=True)
    rows = [tuple(map(int, line.split())) for line in found.stdout.splitlines()]
    return {pid for pid, group in rows if group == process and pid != process}


def gone(process: int) -> bool:
    """Whether all others of the group end within some seconds."""
    for _ in range(100):
        if not children(process):
            return True
        time.sleep(0.1)
    return False


@pytest.mark.slow
@pytest.mark.parametrize(("place", "number"), ENDS)
def test_nothing_is_left_of_an_encode_that_is_ended(
    ball: Path, tmp_path: Path, place: str, number: signal.Signals
) -> None:
    out = tmp_path / "out.nisp"
    command = [sys.executable, "-c", PROGRAM, place, str(int(number)), str(ball), "-o", str(out)]
    command += ["--geometry", "field"]
    options = ["--preset", "fast", "--progress", "plain"]
    with subprocess.Popen(
        [*command, *options], stderr=subprocess.PIPE, text=True, start_new_session=True, cwd=ROOT
    ) as run:
        _, said = run.communicate(timeout=300)
    assert run.returncode == {signal.SIGINT: 130, signal.SIGTERM: 143}[number], said
    assert said.splitlines()[-1].endswith("; files are written whole or not at all")
    assert "Traceback" not in said
    assert list(tmp_path.iterdir()) == []
    assert gone(run.pid)


UNWRAPPING = """
import os, signal, sys, time
from nispcodec_cli import main
import nispcodec.bake.unwrap

if __name__ == "__main__":
    import multiprocessing.process as process
    signal.signal(signal.SIGINT, signal.default_int_handler)
    start = process.BaseProcess.start
    def started(child):
        start(child)
        os.kill(os.getpid(), int(sys.argv[1]))
    process.BaseProcess.start = started
    main(["encode", *sys.argv[2:]])
"""


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_no_process_is_left_of_an_unwrapping_that_is_ended(
    ball: Path, tmp_path: Path, number: signal.Signals
) -> None:
    program, out = tmp_path / "program.py", tmp_path / "out.nisp"
    program.write_text(UNWRAPPING)
    command: list[str | Path] = [sys.executable, program, str(int(number)), ball]
    command += ["-o", out, "--unwrap"]
    with subprocess.Popen(
        command, stderr=subprocess.PIPE, text=True, start_new_session=True
    ) as run:
        _, said = run.communicate(timeout=100)
    assert run.returncode == {signal.SIGINT: 130, signal.SIGTERM: 143}[number], said
    assert "Traceback" not in said
    assert not out.exists()
    assert gone(run.pid)


def test_sigterm_is_an_exception_inside_and_as_before_outside() -> None:
    before = signal.getsignal(signal.SIGTERM)
    with pytest.raises(Terminated), ending_on_sigterm():
        os.kill(os.getpid(), signal.SIGTERM)
    assert signal.getsignal(signal.SIGTERM) is before


def test_other_threads_leave_sigterm_alone() -> None:
    seen = []

    def work() -> None:
        with ending_on_sigterm():
            seen.append(signal.getsignal(signal.SIGTERM))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert seen == [signal.getsignal(signal.SIGTERM)]
