from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from nispcodec.core.document import Document
from nispcodec.format import unpack
from nispcodec.format.codings import registry
from nispcodec.model import NispModel
from tests.cli.conftest import nisp


def recoded(model: Path, *options: object) -> tuple[Document, Document]:
    """The document before and after."""
    output = model.with_name("recoded.nisp")
    result = nisp("recode", model, "-o", output, *options)
    assert result.exit_code == 0, result.output
    assert nisp("verify", output).exit_code == 0
    return unpack(model.read_bytes()), unpack(output.read_bytes())


def same_answers(before: Document, after: Document) -> bool:
    """The networks compute the same, to the last bit."""
    points = np.random.default_rng(0).uniform(-1, 1, (50, 3))
    first, second = NispModel(before), NispModel(after)
    return (
        np.array_equal(first.sdf(points), second.sdf(points))
        and np.array_equal(first.charts(points), second.charts(points))
        and np.array_equal(first.uv(points), second.uv(points))
    )


@pytest.mark.parametrize("coding", registry.CODINGS)
def test_another_coding_computes_the_same(model: Path, coding: str) -> None:
    before, after = recoded(model, "--coding", coding)
    assert same_answers(before, after)
    assert after.textures == before.textures


def test_other_images(model: Path) -> None:
    before, after = recoded(model, "--texture-format", "webp", "--texture-quality", 50)
    assert same_answers(before, after)
    assert [texture.mime for texture in after.textures] == ["image/webp"]


def test_no_images(model: Path) -> None:
    before, after = recoded(model, "--no-textures")
    assert same_answers(before, after)
    assert after.textures == ()


def test_a_damaged_file_leaves_no_output(model: Path) -> None:
    model.write_bytes(model.read_bytes()[:-1])
    output = model.with_name("recoded.nisp")
    assert nisp("recode", model, "-o", output).exit_code == 2
    assert list(model.parent.iterdir()) == [model]
