from __future__ import annotations

import weakref

from nispcodec.core.memory import freeing
from nispcodec.core.progress import Progress


class Held:
    """Something that holds itself, as what has a method of its own as a listener."""

    def __init__(self) -> None:
        self.held = self


def test_a_new_stage_frees_what_only_holds_itself() -> None:
    heard: list[Progress] = []
    listen = freeing(heard.append)
    listen(Progress(stage="fit"))
    gone = weakref.ref(Held())
    told = [Progress(stage="fit"), Progress(network="sdf", stage="rounding")]
    for update in told:
        listen(update)
    assert gone() is not None
    listen(Progress(stage="surface"))
    assert gone() is None
    assert heard[1:3] == told
