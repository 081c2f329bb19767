"""Several networks at once: the same whatever the threads; one error or Ctrl-C ends them all."""

from __future__ import annotations

import math
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from nispcodec.core.errors import FitError
from nispcodec.core.progress import Progress, silent
from nispcodec.train.workers import fit_networks
from tests.train.fits import ENGINE, chart_task, judged_by, sdf_task

ROOT = Path(__file__).parents[2]


def fits_running() -> int:
    return sum(thread.name.startswith("fit ") for thread in threading.enumerate())


def ended_within(seconds: float) -> bool:
    until = time.monotonic() + seconds
    while fits_running() and time.monotonic() < until:
        time.sleep(0.05)
    return not fits_running()


def test_the_same_seed_gives_the_same_weights_on_any_number_of_threads() -> None:
    tasks = [sdf_task(100), chart_task(100)]
    results = [
        fit_networks(tasks, seed, ENGINE, threads, silent)
        for seed, threads in ((0, 1), (0, 2), (0, 5), (1, 2))
    ]
    weights = [result["sdf"].tensors["weight.1"] for result in results]
    assert all(np.array_equal(weights[0], each) for each in weights[1:3])
    assert not np.array_equal(weights[0], weights[3])


def test_an_interrupt_stops_every_network() -> None:
    steps: dict[str, int] = {}

    def interrupted(progress: Progress) -> None:
        steps[progress.network] = progress.step
        if progress.network == "sdf" and progress.step >= 50:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fit_networks([sdf_task(100_000), chart_task(100_000)], 0, ENGINE, 2, interrupted)
    assert max(steps.values()) < 1000
    assert ended_within(10)


def test_an_error_in_one_network_is_the_error_of_all() -> None:
    hopeless = judged_by(chart_task(), lambda outputs, samples: math.nan)
    with pytest.raises(FitError, match=r"chart network.*does not converge"):
        fit_networks([sdf_task(100_000), hopeless], 0, ENGINE, 2, silent)
    assert ended_within(10)


def test_progress_is_told_in_the_thread_that_asked() -> None:
    heard = set()
    fit_networks([sdf_task(50)], 0, ENGINE, 2, lambda _: heard.add(threading.current_thread()))
    assert heard == {threading.current_thread()}


def test_a_process_ends_in_peace_while_others_are_still_fitted() -> None:
    """One fit fails, the other is in the middle of compiled code."""
    code = (
        "from dataclasses import replace\n"
        "from nispcodec.core.network import NetworkSpec\n"
        "from nispcodec.core.progress import silent\n"
        "from nispcodec.train.backend.choice import choose_engine\n"
        "from nispcodec.train.workers import fit_networks\n"
        "from tests.train.fits import chart_task, judged_by, sdf_task\n"
        "long = replace(sdf_task(100_000), spec=NetworkSpec((66,) * 5, 1))\n"
        "hopeless = judged_by(chart_task(), lambda outputs, samples: float('nan'))\n"
        "engine = choose_engine('auto', 'cpu', False, silent)\n"
        "fit_networks([long, hopeless], 0, engine, 2, silent)\n"
    )
    run = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True)
    assert run.returncode == 1, run.stderr
    assert "FitError: chart network" in run.stderr
