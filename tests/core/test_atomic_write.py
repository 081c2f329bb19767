"""Files are written whole or not at all, even when the writer is killed."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from nispcodec.core.atomic_write import write_atomic
from nispcodec.core.errors import NispError

SIZE = 2**22
WRITER = """
import sys
from pathlib import Path
from nispcodec.core.atomic_write import write_atomic
path = Path(sys.argv[1])
print("ready", flush=True)
while True:
    for letter in (b"a", b"b"):
        write_atomic(path, letter * int(sys.argv[2]))
"""


@pytest.mark.parametrize("milliseconds", [0, 3, 11, 29, 53])
def test_a_killed_writer_leaves_the_old_file_or_the_new_one(
    tmp_path: Path, milliseconds: int
) -> None:
    path = tmp_path / "model.nisp"
    path.write_bytes(b"o" * SIZE)
    command = [sys.executable, "-c", WRITER, str(path), str(SIZE)]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as writer:
        assert writer.stdout is not None
        assert writer.stdout.readline() == b"ready\n"
        time.sleep(milliseconds / 1000)
        writer.send_signal(signal.SIGKILL)
    content = path.read_bytes()
    assert content in (b"o" * SIZE, b"a" * SIZE, b"b" * SIZE)


def test_it_replaces_and_leaves_nothing_beside(tmp_path: Path) -> None:
    path = tmp_path / "model.nisp"
    for content in (b"old", b"new"):
        write_atomic(path, content)
        assert path.read_bytes() == content
    assert list(tmp_path.iterdir()) == [path]


def test_a_folder_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(NispError, match="cannot be written"):
        write_atomic(tmp_path / "none" / "model.nisp", b"")


def test_a_path_with_nul_is_an_error_in_words(tmp_path: Path) -> None:
    for path in (tmp_path / "a\0b.nisp", tmp_path / "a\0b" / "c.nisp"):
        with pytest.raises(NispError, match="expected a path without NUL"):
            write_atomic(path, b"")
    assert not list(tmp_path.iterdir())
