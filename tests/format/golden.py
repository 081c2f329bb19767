"""The worked example of `format_spec.md`: |x| - 0.5 as a network of two rectified units."""

from __future__ import annotations

import numpy as np

from nispcodec.core.asset import Material
from nispcodec.core.document import ChartTable, Document, Field, Frame
from nispcodec.core.network import Network, NetworkSpec


def slab() -> Document:
    """A slab one unit thick in a world frame twice as large, its weights quantized in part."""
    spec = NetworkSpec((2,), 1, activation="relu")
    tensors = {
        "weight.0": np.array([[1, 0, 0], [-1, 0, 0]], np.float32),
        "bias.0": np.zeros(2, np.float32),
        "weight.1": np.array([[1, 1]], np.float32),
        "bias.1": np.array([-0.5], np.float32),
    }
    return Document(
        frame=Frame((0.0, 0.0, 3.0), 2.0),
        materials=(Material("slab", base_color=(0.5, 0.25, 1.0, 1.0)),),
        textures=(),
        field=Field(
            charts=ChartTable(np.zeros(1, np.int32), np.zeros(1, np.bool_)),
            sdf=Network(spec, tensors, {"weight.0": 0.5, "weight.1": 0.5}),
        ),
    )
