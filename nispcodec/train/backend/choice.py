"""Which backend an encode trains with: decided once, before anything is computed."""

from __future__ import annotations

from nispcodec.core.errors import FitError, NispError
from nispcodec.core.extras import require
from nispcodec.core.progress import Listener, Progress
from nispcodec.train.backend.native.engine import NativeEngine
from nispcodec.train.backend.native.library import NativeError
from nispcodec.train.backend.protocol import Engine


def choose_engine(wanted: str, device: str, published: bool, listen: Listener) -> Engine:
    """The engine `wanted` ("auto", "native", "torch") on a device ("auto", "cpu", "cuda:1").

    "auto" is the native one wherever that can do the work: it needs no torch, and for networks as
    small as these it is faster than a GPU. Torch does what the native one cannot: CUDA, and the
    `published` networks. A native engine that does not load is told as a warning.
    Raises FitError when the device is not there or the native engine, asked for, does not load,
    NispError when torch is needed and not installed.
    """
    if wanted == "torch" or published or device.startswith("cuda"):
        return _torch(device)
    try:
        return NativeEngine()
    except NativeError as error:
        if wanted == "native":
            raise FitError(f"engine native: {error}") from error
        try:
            engine = _torch(device)
        except NispError as missing:
            raise NispError(f"{missing}; the native engine: {error}") from error
        listen(Progress(warning=f"trained with torch, which takes several times as long: {error}"))
        return engine


def _torch(device: str) -> Engine:
    require("torch", extra="torch", what_for="training with torch")
    from nispcodec.train.backend.torch.engine import torch_engine

    return torch_engine(device)
