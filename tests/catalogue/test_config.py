from __future__ import annotations

import pytest

from nispcodec.catalogue import config
from nispcodec.catalogue.config import BatchConfig, machine_memory
from nispcodec.core.errors import NispError


def test_cores_are_filled_as_far_as_memory_goes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(config, "cores", lambda: 16)
    monkeypatch.setattr(config, "machine_memory", lambda: 10_000_000_000)
    usual = BatchConfig()
    assert usual.jobs_here() == 6
    assert usual.memory_here() == 1_500_000_000
    assert BatchConfig(memory=4_000_000_000).jobs_here() == 2
    assert BatchConfig(jobs=3).memory_here() == 3_000_000_000
    assert BatchConfig(jobs=3, memory=7).memory_here() == 7
    monkeypatch.setattr(config, "machine_memory", lambda: 1_000_000)
    assert usual.jobs_here() == 1


def test_this_machine_has_memory() -> None:
    assert machine_memory() > 100_000_000


@pytest.mark.parametrize("wrong", [{"jobs": -1}, {"timeout": float("nan")}, {"engine": "abacus"}])
def test_what_makes_no_sense_is_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(NispError, match="expected"):
        BatchConfig(**wrong)  # type: ignore[arg-type]
