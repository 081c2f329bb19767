"""Which backend trains: the native one where it can, torch where it must, and never in silence."""

from __future__ import annotations

import pytest

from nispcodec.core.errors import FitError, NispError
from nispcodec.core.progress import Progress
from nispcodec.train.backend import choice
from nispcodec.train.backend.choice import choose_engine
from nispcodec.train.backend.native.library import NativeError


class Native:
    """Stands for the native engine where there is a compiler."""

    name = "native"


def broken() -> None:
    raise NativeError("no native backend: it was not built")


@pytest.fixture
def heard() -> list[Progress]:
    return []


@pytest.mark.parametrize(
    ("wanted", "device", "published", "name"),
    [
        ("auto", "auto", False, "native"),
        ("auto", "cpu", False, "native"),
        ("native", "cpu", False, "native"),
        ("torch", "cpu", False, "torch"),
        ("auto", "cpu", True, "torch"),
    ],
)
def test_the_native_engine_does_what_it_can(
    wanted: str,
    device: str,
    published: bool,
    name: str,
    heard: list[Progress],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(choice, "NativeEngine", Native)
    assert choose_engine(wanted, device, published, heard.append).name == name
    assert not heard


def test_without_the_native_engine_torch_is_taken_with_a_warning(
    heard: list[Progress], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(choice, "NativeEngine", broken)
    assert choose_engine("auto", "auto", False, heard.append).name == "torch"
    (update,) = heard
    assert update.warning.startswith("trained with torch")
    assert update.warning.endswith("no native backend: it was not built")


def test_a_native_engine_that_was_asked_for_is_an_error_where_it_is_not(
    heard: list[Progress], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(choice, "NativeEngine", broken)
    with pytest.raises(FitError, match="engine native: no native backend: it was not built"):
        choose_engine("native", "cpu", False, heard.append)


def test_without_either_it_says_what_to_install_and_why(
    heard: list[Progress], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(choice, "NativeEngine", broken)
    monkeypatch.setattr("nispcodec.core.extras.find_spec", lambda name: None)
    said = r"training with torch needs torch.*nispcodec\[torch\]'; the native engine: no native"
    with pytest.raises(NispError, match=said):
        choose_engine("auto", "cpu", False, heard.append)
    assert not heard
