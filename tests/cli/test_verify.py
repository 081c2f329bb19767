from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.conftest import nisp

CONFORMANCE = Path(__file__).parents[1] / "conformance"


def test_a_sound_file(model: Path) -> None:
    result = nisp("verify", model)
    assert (result.exit_code, result.output) == (0, f"{model}: sound\n")
    assert json.loads(nisp("verify", model, "--json").output)["sound"]


@pytest.mark.parametrize("name", ["image-jpeg", "image-webp", "material-full", "coding-csr-pruned"])
def test_conformance_files_are_sound(name: str) -> None:
    assert nisp("verify", CONFORMANCE / f"{name}.nisp").exit_code == 0


def test_a_damaged_file(model: Path) -> None:
    data = bytearray(model.read_bytes())
    data[-1] ^= 1
    model.write_bytes(data)
    result = nisp("verify", model)
    assert result.exit_code == 1
    assert "checksum" in result.output
    problem = json.loads(nisp("verify", model, "--json").output)["problems"][0]
    assert (problem["section"], problem["field"]) == ("TXTR", "checksum")


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    assert nisp("verify", tmp_path / "none.nisp").exit_code == 2
