"""Coordinates that came before are found again, and said in few bits."""

from __future__ import annotations

from nispcodec.format.mesh.binary_coder import BinaryCoder, Decoder, Encoder
from nispcodec.format.mesh.stacking import MOST, Pair, Stacking

A, B, C, D = (0, 0), (10, 0), (10, 10), (0, 10)


def square(coder: BinaryCoder) -> Stacking:
    """With the triangles A B C and A C D known."""
    made = Stacking(coder)
    made.note(A, [])
    made.note(B, [])
    made.note(C, [(A, B)])
    made.note(D, [(A, C)])
    for one, other, length in ((A, B, 5), (A, C, 7), (A, D, 5)):
        made.join(one, other, length)
    return made


def answers(coder: BinaryCoder, wanted: list[Pair]) -> list[Pair | None]:
    stacking = square(coder)
    first, second, third = wanted
    return [
        stacking.anywhere(first),
        stacking.beside(A, 7, second),
        stacking.beyond([(A, C, D)], third),
    ]


def test_hits_and_misses_come_back() -> None:
    for wanted in ([A, C, B], [(3, 3), (4, 4), (5, 5)], [D, B, (1, 1)]):
        encoder = Encoder()
        found = answers(encoder, wanted)
        known = [w if w in (A, B, C, D) else None for w in wanted]
        assert found == known
        assert answers(Decoder(encoder.finish()), [A, A, A]) == found


def test_nothing_known_costs_nothing() -> None:
    encoder = Encoder()
    empty = Stacking(encoder)
    assert empty.anywhere(A) is None
    assert empty.beside(A, 1, B) is None
    assert empty.beyond([(A, B, None)], C) is None
    assert encoder.finish() == b""


def test_the_face_itself_is_no_candidate() -> None:
    encoder = Encoder()
    assert square(encoder).beyond([(A, B, C)], C) is None
    assert encoder.finish() == b""


def test_lists_are_bounded() -> None:
    stacking = Stacking(Encoder())
    for each in range(3 * MOST):
        stacking.note((each, 1), [(A, B)])
        stacking.join(A, (each, 1), 1)
    assert len(stacking._thirds[A, B]) == len(stacking._beside[A]) == MOST
