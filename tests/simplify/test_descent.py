"""The search for the candidate that loses least: faces and bits, by whatever counts."""

from __future__ import annotations

import math

from nispcodec.simplify.config import DescentConfig
from nispcodec.simplify.descent import least_loss
from nispcodec.simplify.ladder import Candidate
from tests.simplify.meshes import ball, simplifier

CONFIG = DescentConfig(first_faces=60, least_bits=4, trials=40)


def test_the_best_of_faces_and_bits_is_found() -> None:
    made = simplifier(ball())
    everything = len(made.source.triangles)
    wanted = everything / CONFIG.growth**2, 8, 6

    def loss(found: Candidate) -> float:
        faces, bits, uv_bits = wanted
        bits_off = abs(found.bits - bits) + abs(found.uv_bits - uv_bits)
        return abs(math.log(found.faces / faces)) + bits_off

    found = least_loss(made, loss, CONFIG)
    assert (found.bits, found.uv_bits) == wanted[1:]
    assert abs(math.log(found.faces / wanted[0])) < 0.2


def test_no_more_are_tried_than_may_be_and_the_best_of_them_is_taken() -> None:
    losses: list[float] = []

    def loss(found: Candidate) -> float:
        losses.append(-float(found.size))
        return losses[-1]

    found = least_loss(simplifier(ball()), loss, DescentConfig(trials=4))
    assert len(losses) == 4
    assert -found.size == min(losses)


def test_where_all_lose_the_same_the_smallest_is_sought() -> None:
    made = simplifier(ball())
    found = least_loss(made, lambda _: math.inf, CONFIG)
    assert (found.bits, found.uv_bits) == (CONFIG.least_bits,) * 2
    assert found.faces < 60
