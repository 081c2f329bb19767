#!/usr/bin/env bash
# threadpool_limits(1) holds for the thread that called it: torch in every other thread goes on with all cores
#
# Versions:   torch 2.13.0 (CPU), threadpoolctl 3.8.0, numpy 2.4.6; Linux, libgomp
# Behavior:   OpenMP keeps the number of threads for each thread apart. threadpoolctl sets it for the thread that enters
#             the block alone, and for BLAS libraries with threads of their own (numpy's OpenBLAS) for the whole process.
#             Inside of one block numpy is limited everywhere and torch in the calling thread only; a thread that the
#             block starts asks for all cores. threadpool_info() of the caller shows 1 for both.
# Output seen: in the block: openmp 1, blas 1; in a thread started in it: openmp 4, blas 1 (OMP_NUM_THREADS=4)
# One would guess: a limit on the process' pools, as the name says and BLAS shows; or at least that new threads inherit.
# Who is hurt: whoever runs small torch models in a pool of threads, one core each, and limits once around the pool: every
#             operation of every thread waits for a team of all cores. Two fits of small networks on two busy cores took
#             15 times as long.
# Instead:    torch.set_num_threads(1) in each thread, at its start.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check torch==2.13.0 threadpoolctl==3.8.0 numpy==2.4.6
OMP_NUM_THREADS=4 "$work/venv/bin/python" - <<'PYTHON'
import threading

import numpy as np
import torch
from threadpoolctl import threadpool_info, threadpool_limits

torch.ones(4) @ torch.ones(4)
np.ones((4, 4)) @ np.ones((4, 4))


def seen():
    return {pool["user_api"]: pool["num_threads"] for pool in threadpool_info()}


def in_a_thread():
    found = []
    thread = threading.Thread(target=lambda: found.append(seen()))
    thread.start()
    thread.join()
    return found[0]


print("before:", seen())
with threadpool_limits(1):
    caller, other = seen(), in_a_thread()
print("in the block:", caller)
print("in a thread started in the block:", other)
assert caller == {"blas": 1, "openmp": 1}, "the caller is not limited any more"
assert other["blas"] == 1, "BLAS is not limited in other threads any more"
assert other["openmp"] > 1, "other threads are limited now"
print("as described")
PYTHON
