from __future__ import annotations

import multiprocessing.synchronize
import os
import signal
from dataclasses import replace

import numpy as np
import pytest
from nispcodec_cli.unwrapping import apart

from nispcodec.core.asset import TexturedMesh
from nispcodec.core.errors import MeshError, NispError

MESH = TexturedMesh.geometry_only(np.eye(3), np.arange(3)[None], "m")


def crash(mesh: TexturedMesh) -> TexturedMesh:
    os.kill(os.getpid(), signal.SIGKILL)
    return mesh


def refuse(mesh: TexturedMesh) -> TexturedMesh:
    raise MeshError(f"{mesh.name}: refused")


def renamed(mesh: TexturedMesh) -> TexturedMesh:
    return replace(mesh, name="other")


def test_a_crash_ends_the_other_process_alone() -> None:
    with pytest.raises(NispError, match="m: expected an atlas, found a crash while unwrapping 1"):
        apart(crash, MESH)


def test_results_and_errors_come_back() -> None:
    assert apart(renamed, MESH).name == "other"
    with pytest.raises(MeshError, match="m: refused"):
        apart(refuse, MESH)


def test_no_shared_memory_is_needed(monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(multiprocessing.synchronize.SemLock, "__init__", full)
    assert apart(renamed, MESH).name == "other"
