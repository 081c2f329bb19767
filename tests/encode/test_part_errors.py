"""What an encode tells of each part's errors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import nispcodec
from nispcodec import EncodeConfig
from nispcodec.core.asset import Material
from nispcodec.core.document import Document, Frame
from nispcodec.core.progress import Progress
from nispcodec.encode.part_errors import part_errors
from nispcodec.extract.meshing import textured_mesh
from nispcodec.simplify.closest import Tree
from nispcodec.simplify.errors import Original
from nispcodec.simplify.ladder import Simplifier
from nispcodec.simplify.triangles import Triangles
from tests.geometry.shapes import box_asset
from tests.simplify.meshes import ball


def original_of(triangles: Triangles) -> Original:
    return Original.of(triangles, Tree(triangles.corners), 1000, 0)


def test_each_part_has_its_own_errors() -> None:
    near, far = (
        Simplifier.of(ball(), lambda _: 0).candidate(60, bits, 8).parts for bits in (10, 3)
    )
    document = Document(Frame((0.0, 0.0, 0.0), 1.0), (Material(),), (), None, (*near, *far))
    mesh, _ = textured_mesh(document)
    errors = list(part_errors(document, mesh, original_of(ball()), 4000))
    assert len(errors) == 2
    assert 2 * errors[0][0] < errors[1][0]
    only = replace(document, meshes=near)
    (alone,) = part_errors(only, textured_mesh(only)[0], original_of(ball()), 2000)
    assert errors[0] == pytest.approx(alone, rel=0.2)


def test_an_encode_tells_them_of_every_part_at_its_end() -> None:
    told: list[Progress] = []
    config = EncodeConfig(geometry="mesh", textures=False)
    model = nispcodec.encode(box_asset(), config, told.append)
    (errors,) = [update.part_errors for update in told if update.part_errors]
    assert len(errors) == len(model.document.meshes)
    assert np.max(errors) < 1e-3
