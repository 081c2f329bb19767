from __future__ import annotations

import weakref

import pytest

from nispcodec.core import memory
from nispcodec.core.memory import freeing
from nispcodec.core.progress import Progress, silent


class Held:
    """Something that holds itself, as what has a method of its own as a listener."""

    def __init__(self) -> None:
        self.held = self


def test_what_only_holds_itself_is_freed_before_the_next_encode() -> None:
    gone = weakref.ref(Held())
    assert gone() is not None
    freeing(silent)
    assert gone() is None


def test_stages_give_memory_back_once(monkeypatch: pytest.MonkeyPatch) -> None:
    given: list[str] = []
    monkeypatch.setattr(memory, "give_back", lambda: given.append("stage"))
    heard: list[Progress] = []
    listen = freeing(heard.append)
    told = [
        Progress(stage="fit"),
        Progress(stage="fit", step=1),
        Progress(network="sdf", stage="rounding"),
        Progress(stage="surface"),
    ]
    for update in told:
        listen(update)
    assert len(given) == 2
    assert heard == told
