"""What was frozen is what it was, and decodes to the answers that it had."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from nispcodec.core.errors import FormatError
from nispcodec.format import unpack
from tests.conformance import freeze
from tests.conformance.freeze import FROZEN, LIST, corpus, sums
from tests.conformance.test_conformance import check_the_library

FILES = sorted(FROZEN.glob("*.nisp"))
MALFORMED = sorted((FROZEN / "malformed").glob("*.nisp"))


def test_not_a_byte_has_changed() -> None:
    assert sums(FROZEN) == (FROZEN / LIST).read_text()


@pytest.mark.parametrize("path", FILES, ids=[path.stem for path in FILES])
def test_frozen_files_are_answered(path: Path) -> None:
    check_the_library(path)


@pytest.mark.parametrize("path", MALFORMED, ids=[path.stem for path in MALFORMED])
def test_frozen_malformed_files_are_refused(path: Path) -> None:
    with pytest.raises(FormatError):
        unpack(path.read_bytes())


def test_all_of_a_corpus_is_frozen(tmp_path: Path) -> None:
    source, target = tmp_path / "source", tmp_path / "target"
    (source / "malformed").mkdir(parents=True)
    for name in ("a.nisp", "a.json", "malformed/b.nisp", "malformed/expected.json"):
        (source / name).write_text(json.dumps(name))
    (source / "builder.py").write_text("no part of the corpus")
    freeze.freeze(source, target)
    freeze.freeze(source, target)
    assert corpus(target) == corpus(source)
    assert len(corpus(target)) == 4
    assert sums(target) == (target / LIST).read_text()


def test_what_is_frozen_stays(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "kept").write_text("as it was")
    monkeypatch.setattr(freeze, "FROZEN", tmp_path)
    assert freeze.main([]) == 1
    assert (tmp_path / "kept").read_text() == "as it was"
