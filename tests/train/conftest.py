"""Networks this small do not gain from threads; on a busy machine they only wait for each other."""

from __future__ import annotations

import torch

torch.set_num_threads(1)
