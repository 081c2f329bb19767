"""Files are written whole or not at all, even when the writer is killed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
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


def test_names_may_be_as_long_as_the_file_system_takes(tmp_path: Path) -> None:
    longest = os.pathconf(tmp_path, "PC_NAME_MAX")
    path = tmp_path / ("a" * longest)
    write_atomic(path, b"whole")
    assert path.read_bytes() == b"whole"


def test_a_folder_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(NispError, match="cannot be written"):
        write_atomic(tmp_path / "none" / "model.nisp", b"")


def test_a_path_with_nul_is_an_error_in_words(tmp_path: Path) -> None:
    for path in (tmp_path / "a\0b.nisp", tmp_path / "a\0b" / "c.nisp"):
        with pytest.raises(NispError, match="expected a path without NUL"):
            write_atomic(path, b"")
    assert not list(tmp_path.iterdir())


def test_what_writes_itself_is_given_the_file(tmp_path: Path) -> None:
    path = tmp_path / "a"
    write_atomic(path, lambda file: [file.write(each) for each in (b"one", b"two")])
    assert path.read_bytes() == b"onetwo"


def test_many_writers_of_one_file_leave_one_of_theirs(tmp_path: Path) -> None:
    path = tmp_path / "a"
    contents = [bytes([number]) * 200_000 for number in range(8)]
    with ThreadPoolExecutor(8) as pool:
        list(pool.map(lambda data: write_atomic(path, data), contents * 3))
    assert path.read_bytes() in contents
    assert list(tmp_path.iterdir()) == [path]


FULL = """
import resource, signal, sys
from pathlib import Path
from nispcodec.core.atomic_write import write_atomic
from nispcodec.core.errors import NispError
resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, 50_000))
try:
    write_atomic(Path(sys.argv[1]), bytes(100_000))
except NispError as error:
    print(error)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="limits of POSIX")
def test_a_disk_that_is_full_leaves_what_was_there(tmp_path: Path) -> None:
    path = tmp_path / "a"
    path.write_bytes(b"before")
    command = [sys.executable, "-c", FULL, str(path)]
    run = subprocess.run(command, capture_output=True, text=True, check=True)
    assert run.stdout == f"{path}: cannot be written: File too large\n"
    assert path.read_bytes() == b"before"
    assert list(tmp_path.iterdir()) == [path]
