from __future__ import annotations

from nispcodec.format.codings import registry


def test_numbers_count_from_one_and_fit_the_three_bits_of_a_tag() -> None:
    assert [coding.number for coding in registry.REGISTRY] == list(range(1, 8))


def test_names_are_different_and_each_finds_its_coding() -> None:
    assert len(set(registry.CODINGS)) == len(registry.REGISTRY)
    for coding in registry.REGISTRY:
        assert registry.BY_NAME[coding.name] is registry.BY_NUMBER[coding.number] is coding


def test_a_coding_that_predicts_writes_into_the_stream() -> None:
    assert any(coding.predicts for coding in registry.REGISTRY)
    assert not any(coding.predicts and coding.codec for coding in registry.REGISTRY)
