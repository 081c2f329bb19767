"""The pruning figure's numbers, from the paper's source (Mario: 190 charts)."""

from __future__ import annotations

RATES = [0.20, 0.3685, 0.5152, 0.6437, 0.7542, 0.8442, 0.9117, 0.9565, 0.982, 0.9939]
SIZED = {"chart": 0.8442, "uv": 0.6437}
"""The rates of the table of sizes (table 2)."""

PUBLISHED = {
    "smallest": {
        "chart": [0.9888, 0.9894, 0.9897, 0.9899, 0.9892, 0.9859, 0.9754, 0.9355, 0.4912, 0.4912],
        "uv": [0.0003, 0.0003, 0.0004, 0.0005, 0.0009, 0.0019, 0.0041, 0.0099, 0.0236, 0.1571],
    },
    "smallest_global": {
        "chart": [0.989, 0.9892, 0.9894, 0.9889, 0.9846, 0.9679, 0.491, 0.491, 0.491, 0.491],
        "uv": [0.0003, 0.0003, 0.0003, 0.0006, 0.0009, 0.0018, 0.0039, 0.0094, 0.0234, 0.2168],
    },
    "large_final": {
        "chart": [0.9887, 0.9891, 0.9893, 0.9893, 0.9888, 0.5202, 0.5122, 0.5015, 0.4905, 0.466],
        "uv": [0.0003, 0.0003, 0.0004, 0.0006, 0.0011, 0.0023, 0.0066, 0.0204, 0.2203, 0.2176],
    },
}
"""Strategy -> "chart": accuracy, "uv": mean absolute error, at RATES.

Unpruned is not in the figure: what is 20 % pruned stands for it.
"""

SIZES = {
    "chart": {"dense": 174.4, "coo": 54.9, "csc": 54.5, "csr": 55.0, "dia": 58.5},
    "uv": {"dense": 129.1, "coo": 71.3, "csc": 71.4, "csr": 71.4, "dia": 73.4},
}
"""Table 2: kB as .npz, unpruned ("dense") and pruned at `SIZED` by `smallest`."""
