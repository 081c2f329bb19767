"""Settings of the whole suite."""

from __future__ import annotations

import gc

import pytest
from hypothesis import settings

# A machine that does other work at the same time fails no test by being slow.
settings.register_profile("nispcodec", deadline=None)
settings.load_profile("nispcodec")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Slow tests count for no coverage: tracing triples their time, and others reach it."""
    for item in items:
        if item.get_closest_marker("slow"):
            item.add_marker("no_cover")


def pytest_collection_finish() -> None:
    """What thousands of tests keep is no garbage: every encode would look through all of it."""
    gc.collect()
    gc.freeze()
