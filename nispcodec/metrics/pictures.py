"""How far two pictures of the same view differ."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float32Array
from nispcodec.core.errors import QueryError
from nispcodec.core.extras import require
from nispcodec.metrics.psnr import psnr


def compare_pictures(original: Float32Array, decoded: Float32Array) -> dict[str, float]:
    """PSNR (dB, peak 1) and SSIM (Wang et al. 2004) of two (h, w, 3) pictures in [0, 1].

    Raises QueryError when the shapes differ, NispError without the extra `render`.
    """
    require("skimage", extra="render", what_for="comparing pictures")
    from skimage.metrics import structural_similarity

    if original.shape != decoded.shape:
        raise QueryError(f"pictures: expected shape {original.shape}, found {decoded.shape}")
    error = float(((decoded.astype(np.float64) - original) ** 2).mean())
    similarity = structural_similarity(  # type: ignore[no-untyped-call]
        original, decoded, channel_axis=2, data_range=1.0
    )
    return {"psnr": psnr(error, 1.0), "ssim": float(similarity)}
