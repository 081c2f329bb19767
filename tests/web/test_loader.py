"""The loader of three.js where workers fail: an error each time, no wait for what never comes."""

from __future__ import annotations

import json

from tests.web.programs import HERE, npm_package, run_node


def test_a_worker_that_fails_is_an_error_and_is_replaced() -> None:
    npm_package("three")
    found = json.loads(run_node(HERE / "loader.mjs"))
    assert "did not start" in found["waiting"]
    assert found["later"] == found["waiting"]
    assert found["terminated"] == 1
    assert "out of memory" in found["first"]
    assert found["second"] == "a mesh"
    assert found["workers"] == 2
    assert found["limit"] == "worker limit: expected at least 1, found 0"
