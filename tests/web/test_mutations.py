"""Files that were changed end in a document or in an error that says what is wrong."""

from __future__ import annotations

import json

import pytest

from tests.web.programs import HERE, run_node

CONFORMANCE = HERE.parent / "conformance"
RUNS = 5000


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2])
def test_no_other_error_escapes(seed: int) -> None:
    files = sorted(CONFORMANCE.glob("*.nisp"))
    assert files
    found = json.loads(run_node(HERE / "mutations.mjs", str(RUNS), str(seed), *files))
    assert found["others"] == []
    assert min(found["parsed"], found["refused"]) > RUNS / 10
